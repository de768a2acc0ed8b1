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
