#include "data/buffer.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace interreflect {
namespace {
constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }
}  // namespace

void* allocate_buffer(std::size_t bytes) {
    const bool large = bytes >= huge_page;
    const std::size_t alignment = large ? huge_page : 64;
    void* memory = std::aligned_alloc(alignment, round_up(bytes, alignment));
    if (memory == nullptr) throw std::bad_alloc();
    if (large) madvise(memory, round_up(bytes, alignment), MADV_HUGEPAGE);
    return memory;
}

void free_buffer(void* memory, std::size_t) noexcept { std::free(memory); }

}  // namespace interreflect
