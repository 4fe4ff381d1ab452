#include "math/vector_target.h"

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

namespace interreflect {
namespace {

struct Target {
    const char* name;
    std::int64_t bit;  // smaller for wider vectors
};
constexpr std::array targets{Target{"sse4", HWY_SSE4}, Target{"avx2", HWY_AVX2}, Target{"avx512", HWY_AVX3}};

std::optional<std::string>& forced() {
    static std::optional<std::string> name;
    return name;
}

/// What this machine has and nobody forbade. Highway 1.0.3 forgets what is forbidden whenever it is asked, and runs kernels on
/// all there is.
std::int64_t supported_targets() {
    const std::int64_t supported = hwy::SupportedTargets();
    hwy::GetChosenTarget().Update(supported);
    return supported;
}

std::string list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace

std::vector<std::string> vector_targets() {
    const std::int64_t supported = supported_targets();
    std::vector<std::string> names;
    for (const Target& target : targets)
        if ((supported & target.bit) != 0) names.emplace_back(target.name);
    return names;
}

std::string vector_target() { return vector_targets().back(); }

const std::optional<std::string>& forced_vector_target() { return forced(); }

void force_vector_target(const std::string& name) {
    const auto named = [&](const Target& target) { return target.name == name; };
    const auto target = std::find_if(targets.begin(), targets.end(), named);
    if (target == targets.end()) throw std::invalid_argument("must be sse4, avx2 or avx512, got '" + name + "'");
    if ((supported_targets() & target->bit) == 0)
        throw std::invalid_argument("is " + name + ", which this machine lacks: it has " + list(vector_targets()));
    hwy::DisableTargets(target->bit - 1);
    forced() = name;
}

}  // namespace interreflect
