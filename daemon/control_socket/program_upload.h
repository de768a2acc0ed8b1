#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace contour {

/// How much all clients together may have uploaded and not run yet.
class UploadBudget {
 public:
  explicit UploadBudget(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  bool Take(std::size_t bytes) noexcept {
    if (taken_.fetch_add(bytes) + bytes <= max_bytes_) return true;
    taken_.fetch_sub(bytes);
    return false;
  }
  void GiveBack(std::size_t bytes) noexcept { taken_.fetch_sub(bytes); }
  [[nodiscard]] std::size_t max_bytes() const noexcept { return max_bytes_; }

 private:
  const std::size_t max_bytes_;
  std::atomic<std::size_t> taken_{0};
};

/// A program that comes in pieces, while it comes and until it has been read.
class UploadedText {
 public:
  explicit UploadedText(std::shared_ptr<UploadBudget> budget) : budget_(std::move(budget)) {}
  ~UploadedText() { budget_->GiveBack(bytes_); }
  UploadedText(const UploadedText&) = delete;
  UploadedText& operator=(const UploadedText&) = delete;

  /// False when there is no room, for all clients together.
  bool Append(std::string_view piece) {
    if (!budget_->Take(piece.size())) return false;
    text_ += piece;
    bytes_ += piece.size();
    return true;
  }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  /// The text itself, which stays in the budget for as long as this lives.
  [[nodiscard]] std::string Take() noexcept { return std::move(text_); }

 private:
  std::shared_ptr<UploadBudget> budget_;
  std::string text_;
  std::size_t bytes_ = 0;
};

}  // namespace contour
