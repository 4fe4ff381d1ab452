/// Weighted means of the texels of many maps.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

namespace interreflect {

/// Linear maps between maps of four floats a texel: each output is a mean of a few inputs.
struct SparseMeans {
    struct Share {
        int texel;
        float weight;
    };
    std::vector<int> first;  // share of each output, and the end
    std::vector<Share> shares;

    int outputs() const { return static_cast<int>(first.size()) - 1; }
};

/// Each output is a mean of all inputs. For every input the weight of each output, four times (a texel has four values), and
/// zeros up to whole groups of vectors.
class DenseMeans {
  public:
    static constexpr int group = 32;  // floats: two vectors of sixteen

    DenseMeans(int inputs, int outputs)
        : inputs_(inputs),
          stride_((4 * outputs + group - 1) / group * group),
          weights_(static_cast<std::size_t>(inputs) * stride_) {}
    void set(int input, int output, float weight) {
        for (int k = 0; k < 4; ++k) weights_[static_cast<std::size_t>(input) * stride_ + 4 * output + k] = weight;
    }
    int inputs() const { return inputs_; }
    int stride() const { return stride_; }
    const float* weights() const { return weights_.data(); }

  private:
    int inputs_, stride_;
    std::vector<float> weights_;
};

void halves_to_floats(const std::uint16_t* halves, std::size_t count, float* floats);
void floats_to_halves(const float* floats, std::size_t count, std::uint16_t* halves);
/// `to` has room for outputs() texels.
void apply(const SparseMeans& means, const float* from, float* to);
/// Of four maps at a time; `to` has room for stride() floats each.
void apply(const DenseMeans& means, const float* const from[4], float* const to[4]);

}  // namespace interreflect
