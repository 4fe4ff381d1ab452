/// What the first pixel of every block reflects, for its neighbours.
#pragma once
#include "data/gathered_light.h"
#include "math/parallel.h"
#include "shading/share/interleaved.h"
#include "voxels/glossy/reflections.h"

namespace interreflect {

/// One entry a block, in parallel arrays. Blocks whose first pixel reflects nothing have normal 0.
class SharedReflections {
  public:
    /// sky: whether there is any. All entries must be cleared or entered before `finish`.
    SharedReflections(const Interleaved& share, const GBuffer& gbuffer, bool sky);

    /// The blocks [begin, end) of a row reflect nothing.
    void clear(int row, int begin, int end);
    /// What the first pixel of a block sees: reflection i.
    void enter(int row, int column, const Reflections& seen, int i);

    /// Writes what the pixels of a tile reflect: the mean over the blocks' first pixels within half a block that lie on the same
    /// surface with a lobe as wide, times the lobe's own albedo, radiance also times `scale`. Pixels without such neighbours are
    /// put into `alone`, which must hold the whole tile.
    void finish(const Tile& tile, const GBuffer& gbuffer, const LobeTables& tables, float scale, GlossyLight& light,
                Reflections& alone) const;

    enum { px, py, pz, nx, ny, nz, alpha, r, g, b, planes_without_sky, sky_r = planes_without_sky, sky_g, sky_b, planes };
    const float* plane(int number, int row) const { return values_.data() + at(number, row); }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool has_sky() const { return sky_; }
    const Interleaved& share() const { return share_; }

  private:
    static constexpr int vector = 16;  // floats, the most that are read at once
    std::size_t at(int number, int row) const { return (static_cast<std::size_t>(number) * rows_ + row) * row_; }
    float* plane(int number, int row) { return values_.data() + at(number, row); }

    Interleaved share_;
    int columns_, rows_;
    std::size_t row_;  // floats; a vector beyond the last block may be read
    bool sky_;
    Buffer<float> values_;
};

}  // namespace interreflect
