// Counts what the calling thread of a test program allocates. It replaces operator new, so that one source of a program
// includes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace hysteron::test {
inline thread_local std::uint64_t allocations = 0;

inline void* counted_malloc(std::size_t size) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}

inline void* counted_new(std::size_t size) {
  if (void* const memory = counted_malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
}  // namespace hysteron::test

// Not inlined: GCC would see free() beside the standard's operator new, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return hysteron::test::counted_new(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return hysteron::test::counted_new(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return hysteron::test::counted_malloc(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return hysteron::test::counted_malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
