#pragma once

namespace contour {

/// While it lives SIGINT and SIGTERM end the process at once, with status 1 and a line on stderr: for long
/// computations that cannot be asked to stop, while nothing moves and no file is being written. Then the
/// handlers from before are in force again. One at a time.
class EndsAtOnce {
 public:
  /// `saying`: with its line end; a literal.
  explicit EndsAtOnce(const char* saying);
  ~EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;

 private:
  void (*interrupt_)(int);
  void (*terminate_)(int);
};

}  // namespace contour
