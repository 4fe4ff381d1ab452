/// A dummy technique, as a newcomer would add one: this file, and one name in the stage's list (module.cpp).
#pragma once
#include <string>
#include <variant>

#include "data/technique.h"

namespace interreflect {

struct Median {
    int taps = 3;

    bool operator==(const Median&) const = default;
    static constexpr auto description =
        describe("Median", "The middle of the neighbours.", Source{"a test"},
                 Param{"taps", &Median::taps, "neighbours looked at", Unit::pixels, between(1, 9)});
};

struct Brightest {
    double radius = 1.5;
    bool wrap = false;
    std::string metric = "luminance";
    std::variant<Median> first = Median{};

    bool operator==(const Brightest&) const = default;
    static constexpr auto description =
        describe("Brightest", "The brightest neighbour.", Source{"a test", "section 1"},
                 Param{"radius", &Brightest::radius, "reach of the search", Unit::pixels, above(0)},
                 Param{"wrap", &Brightest::wrap, "whether the picture repeats"},
                 Param{"metric", &Brightest::metric, "what brightness means", Unit::none, one_of("luminance|largest")},
                 Param{"first", &Brightest::first, "what runs before"});
};

}  // namespace interreflect
