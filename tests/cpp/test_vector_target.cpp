#include "math/vector_target.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

using namespace interreflect;

namespace {

/// As in the Python module: the environment's INTERREFLECT_VECTORS forces a target on every test of this program.
class ForcedVectors : public testing::Environment {
    void SetUp() override {
        if (const char* name = std::getenv("INTERREFLECT_VECTORS")) force_vector_target(name);
    }
};
const testing::Environment* const forced_vectors = testing::AddGlobalTestEnvironment(new ForcedVectors);

TEST(VectorTarget, IsTheWidestOfTheMachineOrTheForcedOne) {
    ASSERT_FALSE(vector_targets().empty());
    EXPECT_EQ(vector_targets().front(), "sse4");
    EXPECT_EQ(vector_target(), forced_vector_target().value_or(vector_targets().back()));
    EXPECT_THROW(force_vector_target("avx1024"), std::invalid_argument);
}

TEST(VectorTarget, ForcingOneTakesWiderOnesAway) {
    // In a process of its own: a target once taken away does not come back.
    const auto force_both = [] {
        force_vector_target("sse4");
        const bool one = vector_target() == "sse4" && vector_targets().size() == 1;
        try {
            force_vector_target("avx2");
        } catch (const std::invalid_argument& lacks) {
            std::_Exit(one && std::string(lacks.what()).find("lacks: it has sse4") != std::string::npos ? 0 : 1);
        }
        std::_Exit(2);
    };
    EXPECT_EXIT(force_both(), testing::ExitedWithCode(0), "");
}

}  // namespace
