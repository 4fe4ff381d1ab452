/// What one place in a grid gives to the eight around it.
#pragma once
#include "math/parallel.h"
#include "math/vectors.h"

namespace interreflect {

/// Eight nodes of a lattice at whole numbers, and the share of each, along every axis.
struct Between {
    ivec3 first;
    vec3 beyond;  // share of the node after it

    /// Of `nodes` along each axis; what lies beyond the last ones goes to them.
    Between(const vec3& at, const ivec3& nodes) {
        const vec3 inner = glm::clamp(at, vec3(0), vec3(nodes - 1));
        first = glm::max(glm::min(ivec3(inner), nodes - 2), ivec3(0));
        beyond = inner - vec3(first);
    }
    /// Calls visit(node, share) for those with a share, in order.
    template <class Visit>
    void each(const Visit& visit) const {
        for (int corner = 0; corner < 8; ++corner) {
            const ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
            const vec3 share = glm::mix(1.0f - beyond, beyond, vec3(step));
            const float weight = share.x * share.y * share.z;
            if (weight != 0.0f) visit(first + step, weight);
        }
    }
};

inline constexpr int slabs_of_nodes = 16;  // that one thread writes each

/// Adds up what many places give: calls place(i) and, for its nodes, add(i, number of the node, share), in the same order for
/// every node whatever the threads.
template <class Place, class Add>
void spread(std::size_t count, const ivec3& nodes, const Place& place, const Add& add) {
    parallel_pieces(slabs_of_nodes, [&](std::size_t slab) {
        const auto layer = [&](std::size_t k) {
            return static_cast<int>(k * static_cast<std::size_t>(nodes.z) / slabs_of_nodes);
        };
        const int from = layer(slab), to = layer(slab + 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Between& at = place(i);
            if (at.first.z >= to || at.first.z + 1 < from) continue;
            at.each([&](const ivec3& node, float share) {
                if (node.z >= from && node.z < to)
                    add(i, static_cast<std::size_t>(node.x + nodes.x * (node.y + nodes.y * node.z)), share);
            });
        }
    });
}

}  // namespace interreflect
