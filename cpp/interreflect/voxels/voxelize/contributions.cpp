#include "voxels/voxelize/contributions.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <span>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// Ranges of cells that are merged at a time: their voxels stay in a core's own cache, and there are enough for many cores.
struct Buckets {
    int shift = 11;
    std::size_t count = 1;

    explicit Buckets(std::size_t cells) {
        while ((cells >> shift) > 1024) ++shift;
        count = (cells >> shift) + 1;
    }
};

/// Contributions of one piece by bucket, within a bucket in the order they were emitted.
template <class Item>
struct Sorted {
    std::span<const Item> items;
    std::vector<std::uint32_t> first;  // of each bucket, and the end

    std::span<const Item> bucket(std::size_t b) const {
        return first.empty() ? std::span<const Item>() : items.subspan(first[b], first[b + 1] - first[b]);
    }
};

/// Memory that one thread fills with the contributions of its pieces: few large blocks instead of many pages.
template <class Item>
class Store {
  public:
    Sorted<Item> keep(std::span<const Item> items, const Buckets& buckets) {
        Sorted<Item> sorted;
        if (items.empty()) return sorted;
        sorted.first.assign(buckets.count + 1, 0);
        for (const auto& item : items) ++sorted.first[(item.cell >> buckets.shift) + 1];
        for (std::size_t b = 0; b < buckets.count; ++b) sorted.first[b + 1] += sorted.first[b];
        const std::span<Item> out = take(items.size());
        std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
        for (const auto& item : items) out[next[item.cell >> buckets.shift]++] = item;
        sorted.items = out;
        return sorted;
    }
    std::span<const Item> keep(std::span<const Item> items) {
        const std::span<Item> out = take(items.size());
        std::copy(items.begin(), items.end(), out.begin());
        return out;
    }

  private:
    static constexpr std::size_t items_of_block = (std::size_t{4} << 20) / sizeof(Item);
    std::span<Item> take(std::size_t count) {
        if (blocks_.empty() || used_ + count > blocks_.back().size()) {
            blocks_.emplace_back(std::max(count, items_of_block));
            used_ = 0;
        }
        used_ += count;
        return blocks_.back().span().subspan(used_ - count, count);
    }
    std::vector<Buffer<Item>> blocks_;
    std::size_t used_ = 0;
};

/// Distance of a colour from grey, relative to its brightness [Doghramachi 2013, listing of the voxelization].
float contrast_of(const vec3& colour) {
    constexpr float root_2 = 1.41421356f;
    return glm::length(vec2(colour.r - colour.g, colour.r - colour.b)) / (root_2 + colour.r + colour.g + colour.b);
}

/// Contrasts closer together than this differ by rounding: triangles of one colour are equals.
constexpr float least_contrast = 1e-6f;

/// A contribution and its triangle's sides.
struct Part {
    const Contribution* sums = nullptr;
    const TriangleSide* side = nullptr;
};

/// What has been merged into one voxel so far.
struct Voxel {
    vec4 albedo{0}, position{0};  // as Contribution's
    vec4 normal{0};               // the fourth means nothing
    vec3 emission{0};
    // The largest part of a triangle, the first of equals, among those that face as the first does, and among the others.
    Part largest[2];
    float largest_area[2] = {0, 0};
    vec4 facing{0};  // normal of the first
    Part strongest;  // of the greatest contrast, the first of equals; Blend::max alone
    float contrast = -1.0f;

    void compare_contrast(const Contribution& c, const TriangleSide& side) {
        if (!(c.area() > 0.0f)) return;
        const float found = contrast_of(vec3(c.albedo) / c.area());
        if (!(found > contrast + least_contrast)) return;
        contrast = found;
        strongest = {&c, &side};
    }
    void add(const Contribution& c, const TriangleSide& side) {
        albedo += c.albedo;
        position += c.position;
        normal += side.normal * c.area();
        const bool opposed = glm::dot(vec3(facing), vec3(side.normal)) < 0.0f;
        if (!(c.area() > largest_area[opposed])) return;
        largest[opposed] = {&c, &side};
        largest_area[opposed] = c.area();
        if (!opposed) facing = side.normal;
    }
};

VoxelPoint point_of(const Part& part, const vec3& centre, const Domain& domain) {
    const vec3 mean = vec3(part.sums->position) / part.sums->area();
    return {domain.from_linear(centre + mean), part.side->offset(), vec3(part.side->normal), 1};
}

/// Front and back of a voxel: its largest part; and the largest that faces away, or, where that is but a sliver, the front's own
/// back.
void write_points(const Voxel& voxel, const vec3& centre, std::size_t i, VoxelGrid& grid) {
    const bool second = voxel.largest_area[1] > voxel.largest_area[0];
    const Part &front = voxel.largest[second ? 1 : 0], &other = voxel.largest[second ? 0 : 1];
    grid.points[i] = point_of(front, centre, grid.domain);
    const bool two = other.sums != nullptr && other.sums->area() > 0.1f * front.sums->area() &&
                     glm::dot(vec3(front.side->normal), vec3(other.side->normal)) < -0.2f;
    grid.backs[i] = two ? point_of(other, centre, grid.domain) : grid.points[i];
    if (two) return;
    grid.backs[i].normal = -vec3(front.side->normal);
    grid.backs[i].reflects = front.side->back;
}

void write_voxel(const Voxel& voxel, std::uint32_t cell, std::size_t i, VoxelGrid& grid) {
    const Domain& domain = grid.domain;
    const float area = voxel.albedo.w, total = voxel.position.w, share = 1.0f / area;
    const Part& strongest = voxel.strongest;
    const vec3 centre = domain.reference(cell);
    grid.cell[i] = cell;
    grid.albedo[i] =
        strongest.sums != nullptr ? vec3(strongest.sums->albedo) / strongest.sums->area() : vec3(voxel.albedo) * share;
    grid.emission[i] = voxel.emission * share;
    grid.position[i] = domain.from_linear(centre + vec3(voxel.position) * share);
    grid.opacity[i] = total > area ? area / total : 1.0f;
    grid.area[i] = area;
    // Opposite sides that cancel leave rounding only: 1e-3 of the area is no direction.
    const vec3 normal(voxel.normal);
    const float length = glm::length(normal);
    grid.normal[i] = length > 1e-3f * area ? normal / length : vec3(0);
    if (strongest.side != nullptr) grid.normal[i] = vec3(strongest.side->normal);
    write_points(voxel, centre, i, grid);
}

void resize(VoxelGrid& grid, std::size_t size) {
    grid.cell = Buffer<std::uint32_t>(size);
    grid.albedo = Buffer<vec3>(size);
    grid.normal = Buffer<vec3>(size);
    grid.emission = Buffer<vec3>(size);
    grid.position = Buffer<vec3>(size);
    grid.opacity = Buffer<float>(size);
    grid.area = Buffer<float>(size);
    grid.points = Buffer<VoxelPoint>(size);
    grid.backs = Buffer<VoxelPoint>(size);
}

/// What one thread needs, kept from piece to piece.
struct Worker {
    ContributionSink sink;
    Store<Contribution> surface;
    Store<TriangleSide> sides;
    Store<EmissionContribution> emission;
    std::uint64_t samples = 0;
};

/// Contributions of all pieces, in their order.
struct Pieces {
    std::vector<Sorted<Contribution>> surface;
    std::vector<Sorted<EmissionContribution>> emission;
    std::vector<std::span<const TriangleSide>> sides;

    explicit Pieces(std::size_t count) : surface(count), emission(count), sides(count) {}
};

void merge_bucket(std::size_t bucket, const Buckets& buckets, const CellMarks& marks, const Pieces& pieces, Blend blend,
                  std::vector<Voxel>& voxels, VoxelGrid& grid) {
    const std::uint64_t begin = static_cast<std::uint64_t>(bucket) << buckets.shift;
    const std::uint64_t end = std::min<std::uint64_t>(begin + (std::uint64_t{1} << buckets.shift), grid.domain.cell_count());
    if (begin >= end) return;
    const std::uint32_t first = marks.before(begin);
    voxels.assign(marks.before(end) - first, Voxel{});
    for (std::size_t piece = 0; piece < pieces.surface.size(); ++piece)
        for (const Contribution& c : pieces.surface[piece].bucket(bucket))
            if (marks.marked(c.cell)) {
                const TriangleSide& side = pieces.sides[piece][c.side];
                Voxel& voxel = voxels[marks.before(c.cell) - first];
                voxel.add(c, side);
                if (blend == Blend::max) voxel.compare_contrast(c, side);
            }
    for (const auto& piece : pieces.emission)
        for (const EmissionContribution& e : piece.bucket(bucket)) voxels[marks.before(e.cell) - first].emission += e.emission;
    std::size_t i = 0;
    marks.for_each(begin, end, [&](std::uint32_t cell) {
        write_voxel(voxels[i], cell, first + i, grid);
        ++i;
    });
}

}  // namespace

void CellMarks::number() {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
        first_[i] = sum;
        sum += static_cast<std::uint32_t>(std::popcount(words_[i]));
    }
    first_[words_.size()] = sum;
}

VoxelGrid voxelize_triangles(const Scene& scene, const Domain& domain, Handing handing, const EmitTriangle& emit, Blend blend,
                             const EmitPacket& emit_packet) {
    const auto ranges = triangle_ranges(*scene.geometry);
    const Buckets buckets(domain.cell_count());
    CellMarks marks(domain.cell_count());
    Pieces pieces(ranges.size());
    oneapi::tbb::enumerable_thread_specific<Worker> workers([&] {
        return Worker{ContributionSink(domain, handing, marks), {}, {}, {}, 0};
    });
    parallel_pieces(ranges.size(), [&](std::size_t i) {
        Worker& worker = workers.local();
        worker.sink.clear();
        const auto visit = [&](const VoxelTriangle& triangle) {
            worker.sink.begin(triangle);
            emit(triangle, worker.sink);
            worker.sink.end();
        };
        const PassOver pass_over = [&](const TrianglePacket& packet, std::uint32_t lanes) {
            return emit_packet ? emit_packet(packet, lanes, worker.sink) : 0U;
        };
        for_each_triangle(scene, domain, handing, ranges[i], visit, pass_over);
        pieces.surface[i] = worker.surface.keep(worker.sink.surface.span(), buckets);
        pieces.sides[i] = worker.sides.keep(worker.sink.sides.span());
        pieces.emission[i] = worker.emission.keep(worker.sink.emission.span(), buckets);
        worker.samples += worker.sink.samples;
    });

    marks.number();
    VoxelGrid grid;
    grid.domain = domain;
    resize(grid, marks.count());
    oneapi::tbb::enumerable_thread_specific<std::vector<Voxel>> scratch;
    parallel_pieces(buckets.count, [&](std::size_t b) { merge_bucket(b, buckets, marks, pieces, blend, scratch.local(), grid); });
    for (const Worker& worker : workers) grid.counts.samples += worker.samples;
    grid.counts.voxels = grid.size();
    return grid;
}

}  // namespace interreflect
