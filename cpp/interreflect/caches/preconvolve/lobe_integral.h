#pragma once
#include <memory>

#include "data/caches.h"
#include "data/technique.h"

namespace interreflect {

/// Nothing is convolved in advance: every lobe is integrated over the filled map where it is needed, by directions that are
/// distributed as the lobe (the cosine, or the BRDF times the cosine as the pixel's surface has it).
struct LobeIntegral {
    int samples = 256;

    bool operator==(const LobeIntegral&) const = default;
    static constexpr auto description =
        describe("LobeIntegral", "Every lobe is integrated over the filled map where it is needed.", Source{"Interreflect"},
                 Param{"samples", &LobeIntegral::samples, "directions a lobe", Unit::samples, between(1, 65536)});
};

ConvolvedCaches preconvolve(const LobeIntegral& technique, std::shared_ptr<const FilledCaches> filled);

}  // namespace interreflect
