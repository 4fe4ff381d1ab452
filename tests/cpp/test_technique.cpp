#include <gtest/gtest.h>

#include "data/technique.h"

namespace interreflect {
namespace {

struct Inner {
    double angle = 30.0;
    bool operator==(const Inner&) const = default;
    static constexpr auto description = describe("Inner", "A technique held by another.", Source{"a test"},
                                                 Param{"angle", &Inner::angle, "an angle", Unit::degrees, above_up_to(0, 89)});
};
struct Other {
    bool operator==(const Other&) const = default;
    static constexpr auto description = describe("Other", "Nothing to turn.", Source{"a test"});
};
struct Outer {
    int count = 4;
    std::string mode = "plain";
    std::variant<Inner, Other> inner = Inner{};
    bool operator==(const Outer&) const = default;
    static constexpr auto description = describe(
        "Outer", "Holds another.", Source{"a test"}, Param{"count", &Outer::count, "how many", Unit::none, at_least(1)},
        Param{"mode", &Outer::mode, "how", Unit::none, one_of("plain|fancy")}, Param{"inner", &Outer::inner, "the other"});
};

struct Shared {
    double width = 1.0;
    bool operator==(const Shared&) const = default;
    static constexpr auto params = std::tuple{Param{"width", &Shared::width, "a width", Unit::voxels, between(0, 8)}};
};
struct Sharing : Shared {
    int count = 4;
    bool operator==(const Sharing&) const = default;
    static constexpr auto description = describe("Sharing", "Has knobs that others have too.", Source{"a test"},
                                                 Param{"count", &Sharing::count, "how many"}, Shared::params);
};

template <Described T>
std::string complaint(const T& technique) {
    try {
        check(technique);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(Technique, DefaultsLieInTheirRanges) { EXPECT_EQ(complaint(Outer{}), ""); }

TEST(Technique, ErrorsNameTechniqueFieldBoundAndValue) {
    EXPECT_EQ(complaint(Outer{.count = 0}), "Outer.count must lie in [1, inf), got 0");
    EXPECT_EQ(complaint(Outer{.mode = "odd"}), "Outer.mode must be one of plain, fancy, got 'odd'");
    EXPECT_EQ(complaint(Outer{.inner = Inner{95.0}}), "Inner.angle must lie in (0, 89] degrees, got 95");
    EXPECT_EQ(complaint(Outer{.inner = Inner{std::nan("")}}), "Inner.angle must lie in (0, 89] degrees, got nan");
    EXPECT_EQ(complaint(Outer{.inner = Other{}}), "");
}

TEST(Technique, KnobsSharedByStructFollowItsOwnAndAreCheckedInItsName) {
    std::string names;
    for_each_param<Sharing>([&](const auto& param) { names += std::string(param.name) + " "; });
    EXPECT_EQ(names, "count width ");
    Sharing wide;
    wide.width = 9;
    EXPECT_EQ(complaint(wide), "Sharing.width must lie in [0, 8] voxels, got 9");
    EXPECT_EQ(complaint(Sharing{}), "");
    EXPECT_NE(wide, Sharing{});
}

}  // namespace
}  // namespace interreflect
