#include "data/buffer.h"

#include <sys/mman.h>

#include <cstdlib>
#include <mutex>
#include <new>
#include <vector>

namespace interreflect {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// Large blocks that were freed, for the next of the same size: a frame needs the same buffers as the one before, and the
/// kernel's zeroing of fresh pages costs as much as tracing a G-buffer's rays.
class Pool {
  public:
    void* take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        for (std::size_t i = blocks_.size(); i-- > 0;)
            if (blocks_[i].bytes == bytes) {
                void* memory = blocks_[i].memory;
                blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(i));
                held_ -= bytes;
                return memory;
            }
        return nullptr;
    }
    void keep(void* memory, std::size_t bytes) noexcept {
        const std::lock_guard lock(mutex_);
        if (bytes > most || blocks_.size() == blocks_.capacity()) {
            std::free(memory);
            return;
        }
        blocks_.push_back({memory, bytes});
        held_ += bytes;
        while (held_ > most) {  // the oldest goes first
            held_ -= blocks_.front().bytes;
            std::free(blocks_.front().memory);
            blocks_.erase(blocks_.begin());
        }
    }
    Pool() { blocks_.reserve(256); }

  private:
    // A frame of voxel cone tracing at 1280 x 720 frees some 300 MiB.
    static constexpr std::size_t most = std::size_t{384} << 20;
    struct Block {
        void* memory;
        std::size_t bytes;
    };
    std::mutex mutex_;
    std::vector<Block> blocks_;  // oldest first
    std::size_t held_ = 0;
};

/// Never destroyed: buffers may outlive every static object.
Pool& pool() {
    static Pool* const shared = new Pool;
    return *shared;
}

}  // namespace

void* allocate_buffer(std::size_t bytes) {
    if (bytes < huge_page) {
        void* memory = std::aligned_alloc(64, round_up(bytes, 64));
        if (memory == nullptr) throw std::bad_alloc();
        return memory;
    }
    const std::size_t rounded = round_up(bytes, huge_page);
    if (void* memory = pool().take(rounded)) return memory;
    void* memory = std::aligned_alloc(huge_page, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory, rounded, MADV_HUGEPAGE);
    return memory;
}

void free_buffer(void* memory, std::size_t bytes) noexcept {
    if (bytes < huge_page)
        std::free(memory);
    else
        pool().keep(memory, round_up(bytes, huge_page));
}

}  // namespace interreflect
