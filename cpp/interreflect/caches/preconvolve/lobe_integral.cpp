#include "caches/preconvolve/lobe_integral.h"

namespace interreflect {

ConvolvedCaches preconvolve(const LobeIntegral& technique, std::shared_ptr<const FilledCaches> filled) {
    ConvolvedCaches convolved;
    convolved.level_sizes = {filled->resolution};
    convolved.level_begins = {0};
    convolved.samples = technique.samples;
    convolved.filled = std::move(filled);
    return convolved;
}

}  // namespace interreflect
