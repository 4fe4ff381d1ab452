#include "data/buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>

namespace interreflect {
namespace {

constexpr std::size_t page = std::size_t{4} << 10, huge_page = std::size_t{2} << 20;
// Smaller buffers are left to the allocator, which keeps them too; under sanitizers all are, lest writes beyond one go unseen.
#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t pooled = ~std::size_t{0};
#else
constexpr std::size_t pooled = std::size_t{64} << 10;
#endif
constexpr std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// Bytes from where a huge page begins.
std::size_t beyond_huge_page(const std::byte* at) { return reinterpret_cast<std::uintptr_t>(at) % huge_page; }

/// Address space that begins where a huge page does, without memory yet: as much as asked for or, where the system refuses that,
/// `least` bytes. Null where that is too much.
std::byte* reserve(std::size_t& bytes, std::size_t least) {
    for (const std::size_t wanted : {bytes, round_up(least, huge_page)}) {
        void* found =
            mmap(nullptr, wanted + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (found == MAP_FAILED) continue;
        auto* begin = static_cast<std::byte*>(found);
        begin += (huge_page - beyond_huge_page(begin)) % huge_page;
        madvise(begin, wanted, MADV_HUGEPAGE);
        bytes = wanted;
        return begin;
    }
    return nullptr;
}

/// Large buffers lie in one stretch of addresses. The pages of those that were freed are kept for the next ones: a frame needs as
/// many as the one before, and the kernel's zeroing of fresh pages costs as much as tracing a G-buffer's rays. What is kept and
/// what is in use are together never more than was in use at some time before, so keeping makes no process larger than it has
/// been.
class Pool {
  public:
    void* take(std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        auto first = find(bytes);
        if (first == free_.end()) {
            std::size_t more = most_reserved;
            std::byte* memory = reserve(more, bytes);
            if (memory == nullptr) throw std::bad_alloc();
            free_[memory] = {more, false};
            first = find(bytes);
        }
        std::byte* const begin = first->first;
        carve(first, bytes);
        used_ += bytes;
        most_used_ = std::max(most_used_, used_);
        keep_at_most(most_used_ + slack - used_);
        return begin;
    }
    void give(void* memory, std::size_t bytes) noexcept {
        const std::lock_guard lock(mutex_);
        used_ -= bytes;
        kept_ += bytes;
        put(static_cast<std::byte*>(memory), {bytes, true});
        keep_at_most(std::min(most_idle, most_used_ + slack - used_));
    }

  private:
    // A frame of voxel cone tracing at 1280 x 720 frees some 300 MiB.
    static constexpr std::size_t most_idle = std::size_t{384} << 20, most_reserved = std::size_t{256} << 30,
                                 slack = std::size_t{4} << 20;
    struct Piece {
        std::size_t bytes;
        bool kept;  // has pages
    };
    using Pieces = std::map<std::byte*, Piece>;

    /// The free piece from which on so many bytes are free, most of them kept; of several the smallest. The end where there is
    /// none.
    Pieces::iterator find(std::size_t bytes) {
        auto best = free_.end();
        std::size_t least = 0;
        for (auto begin = free_.begin(); begin != free_.end(); ++begin) {
            std::size_t left = bytes, fresh = 0;
            const std::byte* at = begin->first;
            for (auto i = begin; left != 0 && i != free_.end() && i->first == at; at += i->second.bytes, ++i) {
                const std::size_t part = std::min(left, i->second.bytes);
                left -= part;
                fresh += i->second.kept ? 0 : part;
            }
            const bool worse =
                best != free_.end() && (fresh > least || (fresh == least && begin->second.bytes >= best->second.bytes));
            if (left != 0 || worse) continue;
            best = begin;
            least = fresh;
        }
        return best;
    }
    /// Takes so many bytes out of the free pieces from `first` on.
    void carve(Pieces::iterator first, std::size_t bytes) {
        while (bytes != 0) {
            const auto [begin, piece] = *first;
            const std::size_t part = std::min(bytes, piece.bytes);
            if (part < piece.bytes) free_.emplace(begin + part, Piece{piece.bytes - part, piece.kept});
            first = free_.erase(first);
            bytes -= part;
            kept_ -= piece.kept ? part : 0;
        }
    }
    /// Adds a free piece, one with its neighbours of the same kind.
    void put(std::byte* begin, Piece piece) {
        auto next = free_.lower_bound(begin);
        if (next != free_.end() && next->first == begin + piece.bytes && next->second.kept == piece.kept) {
            piece.bytes += next->second.bytes;
            next = free_.erase(next);
        }
        if (next != free_.begin()) {
            const auto before = std::prev(next);
            if (before->first + before->second.bytes == begin && before->second.kept == piece.kept) {
                before->second.bytes += piece.bytes;
                return;
            }
        }
        free_.emplace_hint(next, begin, piece);
    }
    /// Returns the pages of the last pieces to the system.
    void keep_at_most(std::size_t bytes) {
        while (kept_ > bytes) {
            const auto last = std::find_if(free_.rbegin(), free_.rend(), [](const auto& piece) { return piece.second.kept; });
            std::byte *const end = last->first + last->second.bytes, *begin = end - std::min(last->second.bytes, kept_ - bytes);
            begin = std::max(last->first, begin - beyond_huge_page(begin));  // huge pages stay whole
            const auto gone = static_cast<std::size_t>(end - begin);
            madvise(begin, gone, MADV_DONTNEED);
            kept_ -= gone;
            last->second.bytes -= gone;
            if (last->second.bytes == 0) free_.erase(last->first);
            put(begin, {gone, false});
        }
    }

    std::mutex mutex_;
    Pieces free_;  // by address; adjacent ones differ in kind
    std::size_t kept_ = 0, used_ = 0, most_used_ = 0;
};

/// Never destroyed: buffers may outlive every static object.
Pool& pool() {
    static Pool* const shared = new Pool;
    return *shared;
}

}  // namespace

void* allocate_buffer(std::size_t bytes) {
    if (bytes >= pooled) return pool().take(round_up(bytes, page));
    void* memory = std::aligned_alloc(64, round_up(bytes, 64));
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void free_buffer(void* memory, std::size_t bytes) noexcept {
    if (bytes >= pooled)
        pool().give(memory, round_up(bytes, page));
    else
        std::free(memory);
}

}  // namespace interreflect
