#include <gtest/gtest.h>

#include <cstdint>
#include <thread>
#include <vector>

#include "data/buffer.h"

namespace interreflect {
namespace {

/// Takes and frees buffers of up to 8 MiB in an arbitrary order; counts words that another buffer has overwritten.
int foreign_words(std::uint32_t state) {
    std::vector<Buffer<std::uint32_t>> held;
    int foreign = 0;
    const auto random = [&](std::uint32_t below) { return (state = state * 1664525U + 1013904223U) / 65536U % below; };
    const auto check = [&](const Buffer<std::uint32_t>& buffer) {
        for (std::size_t i = 1; i < buffer.size(); i += 509) foreign += buffer[i] != (buffer[0] ^ static_cast<std::uint32_t>(i));
    };
    for (int k = 0; k < 200; ++k) {
        if (held.size() > 8 || (!held.empty() && random(3) == 0)) {
            const std::size_t gone = random(static_cast<std::uint32_t>(held.size()));
            check(held[gone]);
            std::swap(held[gone], held.back());
            held.pop_back();
        }
        Buffer<std::uint32_t> fresh(1 + random(2048) * 1024);
        fresh[0] = state;
        for (std::size_t i = 1; i < fresh.size(); i += 509) fresh[i] = fresh[0] ^ static_cast<std::uint32_t>(i);
        held.push_back(std::move(fresh));
    }
    for (const auto& buffer : held) check(buffer);
    return foreign;
}

TEST(Buffer, KeepsItsWordsWhileOthersComeAndGo) {
    EXPECT_EQ(foreign_words(1), 0);
    int other = -1;
    std::thread thread([&] { other = foreign_words(2); });
    EXPECT_EQ(foreign_words(3), 0);
    thread.join();
    EXPECT_EQ(other, 0);
}

}  // namespace
}  // namespace interreflect
