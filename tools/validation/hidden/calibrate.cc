#include "tools/validation/hidden/calibrate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "analysis/diagnosis/tuning/model_error.h"
#include "analysis/text/format_text.h"

// A kind's scores exceed the flips in few of the clean logs one has, so that no quantile can be read off: the
// exceedances are taken as exponential (Pickands, Annals of Statistics 3(1), 1975, without the shape), their
// scale drawn towards that of all kinds by one log. That one comes from the median, so that a log which one
// kind goes far wrong in does not raise the allowances of the others.
namespace contour::hidden {
namespace {

constexpr double kHolds = 1.2, kNoChance = 100.0;  // as diagnosis has it
// What one case says about how much of a cause is left may be a third of what the next one says.
constexpr double kLeakageReserve = 3.0;
constexpr double kLeastLeakage = 2e-4;

struct Line {
  std::string log, kind;
  double rows = 0.0, rate = 0.0, explained = 0.0, tested = 0.0, unseen = 0.0, flips = 0.0;
  int accepted = 0;
  bool in_base = false;
};

Line LineFrom(const std::string& text) {
  std::vector<std::string> f;
  std::stringstream stream(text);
  for (std::string field; std::getline(stream, field, ',');) f.push_back(field);
  if (f.size() != 15) throw std::runtime_error("no line of evidence: " + text);
  try {
    return {f[0],
            f[6],
            std::stod(f[1]),
            std::stod(f[2]),
            std::stod(f[4]),
            std::stod(f[11]),
            std::stod(f[12]),
            std::stod(f[13]),
            std::stoi(f[3]),
            f[5] == "1"};
  } catch (const std::logic_error&) {
    throw std::runtime_error("not a number in: " + text);
  }
}

struct Exceeding {
  double count = 0.0, sum = 0.0;
};

bool WouldHold(const Line& l) {
  return !l.in_base && std::isfinite(l.tested) && l.tested > l.flips &&
         (l.unseen > kHolds || l.tested > kNoChance);
}

/// Of an exponential distribution, from its median; as if a log exceeded by 1 besides.
double CommonScale(std::vector<double> exceeding) {
  exceeding.push_back(1.0);
  std::sort(exceeding.begin(), exceeding.end());
  const std::size_t n = exceeding.size();
  return 0.5 * (exceeding[(n - 1) / 2] + exceeding[n / 2]) / std::numbers::ln2;
}

std::string Entry(const std::string& kind, double share, double scale, double leakage, double like) {
  return FormatText("{\"%s\", %.4f, %.2f, %.1e, %.1e},\n", kind.c_str(), share, scale, leakage, like);
}

}  // namespace

std::string ModelErrorTable(std::istream& evidence) {
  std::set<std::string> clean;
  std::map<std::string, Exceeding> kinds;
  std::vector<double> all;
  std::map<std::string, double> leakage, leakage_of_its_kind;
  std::vector<Line> residual_leakage;
  for (std::string text; std::getline(evidence, text);) {
    const Line l = LineFrom(text);
    if (l.rate != diagnosis::kCalibratedRate) continue;
    if (l.log.starts_with("clean_")) {
      clean.insert(l.log);
      if (l.accepted != 0 || !WouldHold(l)) continue;
      const double by = 1e5 * (l.tested - l.flips) / l.rows;
      kinds[l.kind].count += 1.0;
      kinds[l.kind].sum += by;
      // A score of another kind, with a part of the rate for itself.
      if (!diagnosis::IsStructureClass(l.kind)) all.push_back(by);
    } else if (l.log.starts_with("clear_") && l.accepted == 1 && WouldHold(l) &&
               !diagnosis::IsStructureClass(l.kind)) {
      residual_leakage.push_back(l);
    }
  }
  if (clean.empty()) throw std::runtime_error("no machine without an effect among the evidence");
  const auto logs = static_cast<double>(clean.size());
  const double scale = CommonScale(all);
  // The hidden kind is in the case's name: clear_KIND_0001.
  for (const Line& l : residual_leakage) {
    const std::string kind = l.log.substr(6, l.log.rfind('_') - 6);
    // A further order of the kind is another cause, and takes more of what is left than others do.
    const double share = kLeakageReserve * (l.tested - l.flips) / l.explained;
    double& most = l.kind == kind ? leakage_of_its_kind[kind] : leakage[kind];
    most = std::max(most, share);
    kinds.try_emplace(kind);
  }
  // What no log has shown yet, half a log may have.
  std::string out = Entry("", 0.5 / logs, scale, kLeastLeakage, 0.0);
  for (const auto& [kind, e] : kinds) {
    const double others = std::max(kLeastLeakage, leakage[kind]);
    out += Entry(kind, e.count / logs, (e.sum + scale) / (e.count + 1.0), others,
                 std::max(0.0, leakage_of_its_kind[kind] - others));
  }
  return out;
}

}  // namespace contour::hidden
