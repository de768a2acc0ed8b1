#pragma once

// A function that neither waits nor takes memory. Clang's RealtimeSanitizer (preset rtsan) watches everything
// that is called below it; other compilers know nothing of it.
#if defined(__clang__) && defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define CONTOUR_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef CONTOUR_NONBLOCKING
#define CONTOUR_NONBLOCKING
#endif

// A statement that the compiler cannot see through (-Wfunction-effects, tests/architecture), with the reason
// beside it.
#if defined(__clang__)
#define CONTOUR_KNOWN_NONBLOCKING(...)                                                              \
  _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wunknown-warning-option\"") \
      _Pragma("clang diagnostic ignored \"-Wfunction-effects\"") __VA_ARGS__ _Pragma("clang diagnostic pop")
#else
#define CONTOUR_KNOWN_NONBLOCKING(...) __VA_ARGS__
#endif
