/// How fast this machine moves and multiplies numbers: what every limit of the bench divides by.
#pragma once

namespace interreflect::bench {

/// Bytes read a second by all cores, best of `repeats`, GB/s.
double read_bandwidth(int repeats);
/// a = b + s c over arrays far larger than the caches: bytes of the three arrays a second, best of `repeats`, GB/s.
double triad_bandwidth(int repeats);
/// Single-precision fused multiply-adds by all cores on the widest vectors there are, two operations each, GFLOP/s.
double multiply_add_rate(int repeats);
/// Bytes of the vectors that the rates above were measured with.
int vector_bytes();

}  // namespace interreflect::bench
