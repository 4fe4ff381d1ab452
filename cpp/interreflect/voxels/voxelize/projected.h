/// A triangle projected along its dominant axis onto a grid of pixels.
#pragma once
#include "voxels/voxelize/linear_box.h"

namespace interreflect {

/// Pixels are `oversampling` to a voxel; (u, v) is the place on the grid of pixels, and depth counts in pixels too.
struct Projected {
    int u_axis, v_axis, depth_axis;
    float voxels;       // a pixel's edge
    float slope_area;   // of the surface over one pixel, in faces of a voxel
    vec3 corner[3];     // (u, v, depth)
    vec3 lower, upper;  // of the corners
    float depth_start;  // depth = depth_start + dot(depth_slope, (u, v) - (u, v) of the first corner)
    vec2 depth_slope;
    ivec3 first, end;  // pixels of the box: along u, v and depth

    Projected(const VoxelTriangle& t, const LinearBox& box, int oversampling) {
        const vec3 n = glm::abs(t.normal);
        depth_axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
        u_axis = (depth_axis + 1) % 3;
        v_axis = (depth_axis + 2) % 3;
        const auto scale = static_cast<float>(oversampling);
        voxels = 1.0f / scale;
        for (int i = 0; i < 3; ++i) corner[i] = vec3(t.corner[i][u_axis], t.corner[i][v_axis], t.corner[i][depth_axis]) * scale;
        lower = glm::min(glm::min(corner[0], corner[1]), corner[2]);
        upper = glm::max(glm::max(corner[0], corner[1]), corner[2]);
        const float along = t.normal[depth_axis];
        slope_area = voxels * voxels / std::fabs(along);
        depth_slope = vec2(t.normal[u_axis], t.normal[v_axis]) * (-1.0f / along);
        depth_start = corner[0].z;
        for (int i = 0; i < 3; ++i) {
            const int axis = (depth_axis + 1 + i) % 3;
            first[i] = static_cast<int>(std::floor(box.lower[axis] * scale));
            end[i] = static_cast<int>(std::ceil(box.upper[axis] * scale));
        }
    }
    float depth(float u, float v) const {
        return depth_start + depth_slope.x * (u - corner[0].x) + depth_slope.y * (v - corner[0].y);
    }
    /// Rows and columns of the box that the values between `lowest` and `highest` reach along u (0) or v (1).
    int first_of(int axis, float lowest) const {
        return static_cast<int>(std::max(std::floor(lowest), static_cast<float>(first[axis])));
    }
    int last_of(int axis, float highest) const {
        return static_cast<int>(std::min(std::floor(highest), static_cast<float>(end[axis] - 1)));
    }
    /// Of a place on the grid of pixels, in voxels from the domain's corner.
    vec3 position(float u, float v, float d) const {
        vec3 p;
        p[u_axis] = u * voxels;
        p[v_axis] = v * voxels;
        p[depth_axis] = d * voxels;
        return p;
    }
};

/// Texture coordinates as a linear function of the place on the grid of pixels.
struct ProjectedTexcoord {
    vec2 start, origin, along_u, along_v;

    ProjectedTexcoord(const VoxelTriangle& t, const Projected& p) : start(t.texcoord[0]), origin(p.corner[0]) {
        const vec2 e1 = vec2(p.corner[1]) - origin, e2 = vec2(p.corner[2]) - origin;
        const float scale = 1.0f / (e1.x * e2.y - e1.y * e2.x);
        const vec2 t1 = t.texcoord[1] - start, t2 = t.texcoord[2] - start;
        along_u = (t1 * e2.y - t2 * e1.y) * scale;
        along_v = (t2 * e1.x - t1 * e2.x) * scale;
    }
    vec2 at(float u, float v) const { return start + along_u * (u - origin.x) + along_v * (v - origin.y); }
};

}  // namespace interreflect
