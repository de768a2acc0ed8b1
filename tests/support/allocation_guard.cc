#include "tests/support/allocation_guard.h"

#include <cerrno>
#include <cstdlib>

namespace contour::test {
namespace {

// Plain integers in the program's own TLS: reading them can never call the allocator again.
thread_local std::size_t allocation_count = 0;
thread_local std::size_t release_count = 0;

}  // namespace

AllocationGuard::AllocationGuard() noexcept
    : allocations_before_(allocation_count), releases_before_(release_count) {}

std::size_t AllocationGuard::allocations() const noexcept { return allocation_count - allocations_before_; }
std::size_t AllocationGuard::releases() const noexcept { return release_count - releases_before_; }

}  // namespace contour::test

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// A definition in the program comes before the one in libc, for libc's and libstdc++'s own calls too
// (operator new asks malloc). glibc keeps the real functions reachable under these names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  ++contour::test::allocation_count;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  ++contour::test::allocation_count;
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  ++contour::test::allocation_count;
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  ++contour::test::allocation_count;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++contour::test::allocation_count;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
  ++contour::test::allocation_count;
  void* const found = __libc_memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *block = found;
  return 0;
}

void free(void* block) {
  if (block != nullptr) ++contour::test::release_count;
  __libc_free(block);
}
}

#endif
