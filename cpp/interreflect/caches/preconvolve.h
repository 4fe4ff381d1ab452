/// Preconvolve: from the radiance that arrives at a cache to its mean over lobes of any width.
///
///   ConvolvedCaches preconvolve(const Technique&, std::shared_ptr<const FilledCaches>);
///
/// Exact counterpart: LobeIntegral.
#pragma once
#include <variant>

#include "caches/preconvolve/lobe_integral.h"
#include "caches/preconvolve/mip_chain.h"

namespace interreflect {
using Preconvolve = std::variant<LobeIntegral, MipChain>;
}
