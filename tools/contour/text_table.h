#pragma once

#include <string>
#include <vector>

namespace contour {

/// Rows of text with aligned columns: the first to the left, the others to the right, or all to the left.
class TextColumns {
 public:
  explicit TextColumns(bool numbers_right = true) : numbers_right_(numbers_right) {}
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string Text(const std::string& indent = "  ") const;

 private:
  std::vector<std::vector<std::string>> rows_;
  bool numbers_right_;
};

}  // namespace contour
