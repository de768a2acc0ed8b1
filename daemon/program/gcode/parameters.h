#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace contour {

/// A parameter that is set when its block has been read as a whole.
struct Assignment {
  int number = 0;    ///< 0: named
  std::string name;  ///< with a leading underscore: known everywhere, otherwise in the sub where it is set
  double value = 0.0;
};

/// What #parameters stand for. #1 to #30 and names belong to the sub that runs; #31 to #5000 to the program.
/// All numbered ones begin at 0. Nothing outlives the program.
class Parameters {
 public:
  static constexpr int kLastLocal = 30;
  static constexpr int kLast = 5000;
  static constexpr int kPosition =
      5420;  ///< where X of the present position is; Y, Z, A, B, C, U, V, W follow

  static bool Assignable(int number) { return number >= 1 && number <= kLast; }
  /// Nothing when there is no such parameter.
  [[nodiscard]] std::optional<double> Value(int number) const;
  [[nodiscard]] std::optional<double> Value(std::string_view name) const;
  void Set(const Assignment& assignment);

  /// What LinuxCNC knows by names such as _metric; they cannot be set.
  std::map<std::string, double, std::less<>>& modal() { return modal_; }
  [[nodiscard]] bool IsModal(std::string_view name) const { return modal_.find(name) != modal_.end(); }

  /// Present position in the coordinates and units in force, in the order of kPosition.
  std::array<double, 9>& position() { return position_; }

  void EnterSub(const std::vector<double>& arguments);
  void LeaveSub() { frames_.pop_back(); }
  [[nodiscard]] std::size_t depth() const { return frames_.size() - 1; }

 private:
  struct Frame {
    std::array<double, kLastLocal + 1> numbered{};
    std::map<std::string, double, std::less<>> named;
  };

  std::vector<double> numbered_ = std::vector<double>(kLast + 1, 0.0);
  std::map<std::string, double, std::less<>> global_;
  std::map<std::string, double, std::less<>> modal_;
  std::vector<Frame> frames_ = std::vector<Frame>(1);
  std::array<double, 9> position_{};
};

}  // namespace contour
