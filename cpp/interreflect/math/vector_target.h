/// Which vector code kernels run: the widest that this machine has, or one forced by name.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace interreflect {

/// Names of the targets that kernels are compiled for and this machine has, narrowest first: of sse4, avx2, avx512.
std::vector<std::string> vector_targets();
/// What kernels run on: the last of the above, or the forced one.
std::string vector_target();
/// What force_vector_target was told; the ray library heeds it too.
const std::optional<std::string>& forced_vector_target();
/// Call before the first kernel runs. Throws std::invalid_argument for a name that is no target or a target that this machine
/// lacks.
void force_vector_target(const std::string& name);

}  // namespace interreflect
