#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace contour {

/// A configuration that cannot be used. Every message stands alone: `file:line: dotted.key: what was found,
/// what was expected`. Programs print them and exit with status 2.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<std::string> messages)
      : std::runtime_error(Join(messages)), messages_(std::move(messages)) {}

  [[nodiscard]] const std::vector<std::string>& messages() const noexcept { return messages_; }

 private:
  static std::string Join(const std::vector<std::string>& messages) {
    std::string all;
    for (const std::string& m : messages) all += (all.empty() ? "" : "\n") + m;
    return all;
  }

  std::vector<std::string> messages_;
};

}  // namespace contour
