/// How fast this machine moves and multiplies numbers: what every limit divides by.
#pragma once
#include <cstddef>

namespace interreflect {

/// 256 MiB: eight times a large last-level cache.
inline constexpr std::size_t throughput_floats = std::size_t{1} << 26;

/// Bytes of one array read a second by all threads of the current arena, best of `repeats`, GB/s. floats: a multiple of 2^18.
double read_bandwidth(int repeats, std::size_t floats = throughput_floats);
/// a = b + s c over arrays far larger than the caches: bytes of the three arrays a second, best of `repeats`, GB/s.
double triad_bandwidth(int repeats, std::size_t floats = throughput_floats);
/// Single-precision fused multiply-adds by all threads on the widest vectors there are, two operations each, GFLOP/s.
double multiply_add_rate(int repeats);
/// Steps of cones, each two trilinear look-ups of eight texels of four half floats in neighbouring levels of a 128^3 pyramid:
/// what bounds them is the loads, which a rate of multiply-adds does not tell. Million a second by all threads.
double cone_step_rate(int repeats);
/// Bytes of the vectors that the rates above were measured with.
int vector_bytes();

}  // namespace interreflect
