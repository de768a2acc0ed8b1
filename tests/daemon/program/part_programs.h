#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

// Part programs as others write them: CAM posts with short chords and few decimals, hand-written pockets and
// zigzags. All begin at X0 Y0.
namespace contour::testing {

/// Text with a fixed number of decimals.
class GcodeText {
 public:
  explicit GcodeText(int decimals) {
    text_.setf(std::ios::fixed);
    text_.precision(decimals);
  }
  GcodeText& Line(const std::string& words) {
    text_ << words << "\n";
    return *this;
  }
  GcodeText& To(double x_mm, double y_mm, const char* code = "G1") {
    text_ << code << " X" << x_mm << " Y" << y_mm << "\n";
    return *this;
  }
  [[nodiscard]] std::string str() const { return text_.str() + "M2\n"; }

 private:
  std::ostringstream text_;
};

inline std::string ChordCircle(double radius_mm, double chord_mm, int decimals, double feed_mm_min,
                               const std::string& mode = "") {
  GcodeText text(decimals);
  text.Line("G21 G90 " + mode).Line("F" + std::to_string(feed_mm_min));
  const int n = static_cast<int>(std::lround(2 * std::numbers::pi * radius_mm / chord_mm));
  for (int k = 1; k <= n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    text.To(radius_mm * (std::cos(a) - 1.0), radius_mm * std::sin(a));
  }
  return text.str();
}

/// Archimedes' spiral in chords that follow it within `chord_mm`.
inline std::string Spiral(double turns, double pitch_mm, double chord_mm, int decimals, double feed_mm_min) {
  GcodeText text(decimals);
  text.Line("G21 G90").Line("F" + std::to_string(feed_mm_min));
  for (double a = 0.0; a < 2 * std::numbers::pi * turns;) {
    const double r = 0.2 + pitch_mm * a / (2 * std::numbers::pi);
    a += chord_mm / r;
    text.To(r * std::cos(a) - 0.2, r * std::sin(a));
  }
  return text.str();
}

/// Strokes of letters: pen-up rapids, arcs and curves in short chords, sharp corners.
inline std::string EngravedText(unsigned seed, int letters, double chord_mm, int decimals,
                                double feed_mm_min) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  GcodeText text(decimals);
  text.Line("G21 G90").Line("F" + std::to_string(feed_mm_min));
  for (int k = 0; k < letters; ++k) {
    double x = 2.5 * k, y = 0.0;
    text.To(x, y, "G0");
    for (int stroke = 0; stroke < 3; ++stroke) {
      if (between(0, 1) < 0.5) {
        const double radius = between(0.3, 1.2), begin = between(0, 6.28), sweep = between(-5.0, 5.0);
        const double cx = x - radius * std::cos(begin), cy = y - radius * std::sin(begin);
        const int n = 2 + static_cast<int>(std::abs(sweep) * radius / chord_mm);
        for (int i = 1; i <= n; ++i) {
          x = cx + radius * std::cos(begin + sweep * i / n);
          y = cy + radius * std::sin(begin + sweep * i / n);
          text.To(x, y);
        }
      } else {
        x += between(-1.0, 1.0);
        y += between(-2.0, 2.0);
        text.To(x, y);
      }
    }
  }
  return text.str();
}

/// A rectangular pocket with rounded corners, from inside out, with links between the rounds.
inline std::string Pocket(int rounds, double feed_mm_min) {
  GcodeText text(3);
  text.Line("G21 G90 G17").Line("F" + std::to_string(feed_mm_min));
  for (int k = 1; k <= rounds; ++k) {
    const double w = 2.0 * k, h = 1.5 * k, r = 0.4 * k;
    text.To(w - r, -h).Line("G3 X" + std::to_string(w) + " Y" + std::to_string(-h + r) + " R" +
                            std::to_string(r));
    text.To(w, h - r).Line("G3 X" + std::to_string(w - r) + " Y" + std::to_string(h) + " R" +
                           std::to_string(r));
    text.To(-w + r, h).Line("G3 X" + std::to_string(-w) + " Y" + std::to_string(h - r) + " R" +
                            std::to_string(r));
    text.To(-w, -h + r)
        .Line("G3 X" + std::to_string(-w + r) + " Y" + std::to_string(-h) + " R" + std::to_string(r));
    text.To(0.0, -h);
  }
  return text.str();
}

inline std::string RapidZigzag(int lines) {
  GcodeText text(3);
  text.Line("G21 G90");
  for (int k = 0; k < lines; ++k) text.To(k % 2 == 0 ? 20 : 0, k, "G0").To(k % 2 == 0 ? 20 : 0, k + 1, "G0");
  return text.str();
}

/// Anything: lengths over four decades, all angles, feeds that change, arcs that meet lines at an angle.
inline std::string AnyMoves(unsigned seed, int moves) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  GcodeText text(4);
  text.Line("G21 G91 F1000");
  for (int k = 0; k < moves; ++k) {
    if (k % 7 == 0) text.Line("F" + std::to_string(std::pow(10.0, between(1.5, 4.5))));
    const double length = std::pow(10.0, between(-2.5, 1.0)), heading = between(-3.14, 3.14);
    const double x = length * std::cos(heading), y = length * std::sin(heading);
    if (between(0, 1) < 0.2) {
      std::ostringstream arc;
      arc.precision(7);
      arc << (between(0, 1) < 0.5 ? "G2" : "G3") << std::fixed << " X" << x << " Y" << y << " R"
          << length * between(0.55, 3.0);
      text.Line(arc.str());
    } else {
      text.To(x, y, between(0, 1) < 0.1 ? "G0" : "G1");
    }
  }
  return text.str();
}

struct PartProgram {
  std::string name, text;
  double tolerance_m;  ///< 0: the machine's
};

inline std::vector<PartProgram> PartPrograms() {
  return {{"circle 0.02 mm, 3 decimals", ChordCircle(10, 0.02, 3, 3000), 0},
          {"circle 0.02 mm, 4 decimals", ChordCircle(10, 0.02, 4, 3000), 0},
          {"circle 0.5 mm", ChordCircle(10, 0.5, 3, 6000), 0},
          {"small circle 0.01 mm", ChordCircle(1, 0.01, 3, 3000, "G64 P0.005"), 5e-6},
          {"spiral 0.1 mm", Spiral(5, 0.8, 0.1, 3, 4000), 0},
          {"text", EngravedText(3, 5, 0.05, 3, 1500), 0},
          {"pocket", Pocket(3, 3000), 0},
          {"zigzag", RapidZigzag(10), 0},
          {"diamond", "F3000\nG1 X7.071 Y7.071\nX0 Y14.142\nX-7.071 Y7.071\nX0 Y0\n", 0},
          {"slot", "F5000\nG1 X20\nG3 Y10 J5\nG1 X0\nG3 Y0 J-5\nG1 X20\n", 0},
          {"anything", AnyMoves(5, 60), 0}};
}

}  // namespace contour::testing
