#include "data/buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>

namespace interreflect {
namespace {

constexpr std::size_t page = std::size_t{4} << 10, huge_page = std::size_t{2} << 20;
constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// Fresh pages that begin where a huge page does.
void* map_pages(std::size_t bytes) {
    void* found = mmap(nullptr, bytes + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (found == MAP_FAILED) return nullptr;
    const auto first = reinterpret_cast<std::uintptr_t>(found), begin = round_up(first, huge_page);
    if (begin != first) munmap(found, begin - first);
    if (const std::size_t behind = first + huge_page - begin; behind != 0) munmap(reinterpret_cast<void*>(begin + bytes), behind);
    madvise(reinterpret_cast<void*>(begin), bytes, MADV_HUGEPAGE);
    return reinterpret_cast<void*>(begin);
}

/// Pages that were freed, for the next large buffers: a frame needs as many as the one before, and the kernel's zeroing of fresh
/// pages costs as much as tracing a G-buffer's rays. What is kept and what is in use are together never more than was in use at
/// some time before, so keeping them makes no process larger than it has been.
class Pool {
  public:
    void* take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        if (void* memory = take_kept(bytes)) return use(memory, bytes);
        const std::size_t most = std::max(most_used_, used_ + bytes);
        keep_at_most(most - used_ - bytes);
        void* memory = map_pages(bytes);
        if (memory == nullptr) throw std::bad_alloc();
        return use(memory, bytes);
    }
    void give(void* memory, std::size_t bytes) noexcept {
        const std::lock_guard lock(mutex_);
        used_ -= bytes;
        try {
            keep(reinterpret_cast<std::uintptr_t>(memory), bytes);
        } catch (const std::bad_alloc&) {
            munmap(memory, bytes);
        }
        keep_at_most(most_idle);
    }

  private:
    // A frame of voxel cone tracing at 1280 x 720 frees some 300 MiB.
    static constexpr std::size_t most_idle = std::size_t{384} << 20;

    void* use(void* memory, std::size_t bytes) {
        used_ += bytes;
        most_used_ = std::max(most_used_, used_);
        return memory;
    }
    /// Of the smallest piece that holds so much, its beginning; null where there is none.
    void* take_kept(std::size_t bytes) {
        auto best = kept_.end();
        for (auto i = kept_.begin(); i != kept_.end(); ++i)
            if (i->second >= bytes && (best == kept_.end() || i->second < best->second)) best = i;
        if (best == kept_.end()) return nullptr;
        const auto [begin, size] = *best;
        if (size > bytes) kept_.emplace(begin + bytes, size - bytes);
        kept_.erase(best);
        held_ -= bytes;
        return reinterpret_cast<void*>(begin);
    }
    /// One piece with those next to it.
    void keep(std::uintptr_t begin, std::size_t bytes) {
        auto here = kept_.emplace(begin, bytes).first;
        held_ += bytes;
        if (const auto next = std::next(here); next != kept_.end() && begin + bytes == next->first) {
            here->second += next->second;
            kept_.erase(next);
        }
        if (here == kept_.begin()) return;
        const auto before = std::prev(here);
        if (before->first + before->second != begin) return;
        before->second += here->second;
        kept_.erase(here);
    }
    /// Returns the ends of the largest pieces to the system.
    void keep_at_most(std::size_t bytes) noexcept {
        while (held_ > bytes) {
            const auto largest =
                std::max_element(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
            const std::size_t gone = std::min(largest->second, held_ - bytes);
            munmap(reinterpret_cast<void*>(largest->first + largest->second - gone), gone);
            held_ -= gone;
            largest->second -= gone;
            if (largest->second == 0) kept_.erase(largest);
        }
    }

    std::mutex mutex_;
    std::map<std::uintptr_t, std::size_t> kept_;  // bytes of each piece, no two of which touch
    std::size_t held_ = 0, used_ = 0, most_used_ = 0;
};

/// Never destroyed: buffers may outlive every static object.
Pool& pool() {
    static Pool* const shared = new Pool;
    return *shared;
}

}  // namespace

void* allocate_buffer(std::size_t bytes) {
    if (bytes >= huge_page) return pool().take(round_up(bytes, page));
    void* memory = std::aligned_alloc(64, round_up(bytes, 64));
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void free_buffer(void* memory, std::size_t bytes) noexcept {
    if (bytes >= huge_page)
        pool().give(memory, round_up(bytes, page));
    else
        std::free(memory);
}

}  // namespace interreflect
