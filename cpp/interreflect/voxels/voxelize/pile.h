/// An array that grows: as std::vector, but in buffers, whose memory outlives it for the next one of its size.
#pragma once
#include <algorithm>
#include <span>

#include "data/buffer.h"

namespace interreflect {

template <class T>
class Pile {
  public:
    std::size_t size() const { return size_; }
    T* begin() { return items_.begin(); }
    T* end() { return items_.begin() + size_; }
    T& operator[](std::size_t i) { return items_[i]; }
    std::span<const T> span() const { return {items_.data(), size_}; }

    [[gnu::always_inline]] T& push(const T& item) {
        if (size_ == items_.size()) grow();
        return items_[size_++] = item;
    }
    /// Drops what comes after the first `size`.
    void shrink(std::size_t size) { size_ = size; }
    void clear() { size_ = 0; }

  private:
    static constexpr std::size_t least = (std::size_t{2} << 20) / sizeof(T);
    [[gnu::noinline]] void grow() {
        Buffer<T> larger(std::max(least, 2 * items_.size()));
        std::copy(items_.begin(), items_.end(), larger.begin());
        items_ = std::move(larger);
    }

    Buffer<T> items_;
    std::size_t size_ = 0;
};

}  // namespace interreflect
