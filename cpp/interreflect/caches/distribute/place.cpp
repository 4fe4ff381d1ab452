#include "caches/distribute/place.h"

#include <algorithm>
#include <cmath>

#include "math/parallel.h"

namespace interreflect {
namespace {
constexpr float least_cosine = 0.1f;
}

float tile_angle(const GBuffer& gbuffer, int tile) {
    return static_cast<float>(tile) * CameraRays(gbuffer.camera, gbuffer.width, gbuffer.height).pixel_angle();
}

float tile_footprint(const vec3& eye, const vec3& position, const vec3& geometric_normal, float tile_angle) {
    const vec3 away = position - eye;
    const float distance = glm::length(away);
    const float cosine = distance > 0.0f ? std::fabs(glm::dot(away, geometric_normal)) / distance : 1.0f;
    return distance * tile_angle / std::max(cosine, least_cosine);
}

CachePlaces tiles_of(const GBuffer& gbuffer, int tile) {
    CachePlaces places;
    places.width = gbuffer.width, places.height = gbuffer.height;
    places.tile = std::min(tile, std::max(gbuffer.width, gbuffer.height));
    places.columns = (gbuffer.width + places.tile - 1) / places.tile;
    places.rows = (gbuffer.height + places.tile - 1) / places.tile;
    return places;
}

void place_caches(const GBuffer& gbuffer, std::span<const std::uint32_t> pixels, std::span<const std::uint32_t> members,
                  CachePlaces& places) {
    const std::size_t count = pixels.size();
    places.position = Buffer<vec3>(count), places.normal = Buffer<vec3>(count), places.geometric_normal = Buffer<vec3>(count);
    places.screen = Buffer<vec2>(count), places.footprint = Buffer<float>(count), places.offset = Buffer<float>(count);
    places.body = Buffer<std::uint32_t>(count), places.pixel = Buffer<std::uint32_t>(count);
    places.members = Buffer<std::uint32_t>(count);
    const float angle = tile_angle(gbuffer, places.tile);
    parallel_blocks(count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t at = pixels[i];
            places.position[i] = gbuffer.position[at];
            places.normal[i] = gbuffer.normal[at];
            places.geometric_normal[i] = gbuffer.geometric_normal[at];
            const std::uint32_t column = at % gbuffer.width, row = at / gbuffer.width;
            places.screen[i] = vec2(static_cast<float>(column), static_cast<float>(row)) + 0.5f;
            places.footprint[i] =
                tile_footprint(gbuffer.camera.position, gbuffer.position[at], gbuffer.geometric_normal[at], angle);
            places.offset[i] = gbuffer.offset[at];
            places.body[i] = gbuffer.body[at];
            places.pixel[i] = at;
            places.members[i] = members[i];
        }
    });
    places.counts.caches = count;
}

}  // namespace interreflect
