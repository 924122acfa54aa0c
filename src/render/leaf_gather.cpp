#include "render/leaf_gather.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "radiosity/kernel.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr std::size_t kBlock = 64;
constexpr float kNegligible = 0.002f;  // of a leaf's irradiance: variation of one link that is left alone
constexpr float kMostGain = 4.0f;      // of the kernel at a point over its mean

class LeafGather {
 public:
  explicit LeafGather(const Solution& s) : s_(s), e_(s.elements), begin_(s.elements.size() + 1, 0) {
    for (const Link& l : s.links.all)
      if (carries(l)) ++begin_[l.receiver.index() + 1];
    for (std::size_t i = 0; i < e_.size(); ++i) begin_[i + 1] += begin_[i];
    links_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < s.links.size(); ++i)
      if (carries(s.links.all[i])) links_[next[s.links.all[i].receiver.index()]++] = LinkId(i);
  }

  Rgb indirectAt(ElementId leaf) const {
    const float negligible = kNegligible * gray(e_.radiometry[leaf.index()].indirect);
    RgbSum sum(0.0);
    for (ElementId r = leaf; r.valid(); r = e_.at(r).parent)
      for (std::uint32_t i = begin_[r.index()]; i < begin_[r.index() + 1]; ++i)
        sum += RgbSum(arriving(s_.links[links_[i]], leaf, negligible));
    return Rgb(sum);
  }

 private:
  bool carries(const Link& l) const {
    return l.state == LinkState::Active && l.K > 0 && !isBlack(l.V) && !e_.at(l.sender).emitter;
  }

  Rgb arriving(const Link& l, ElementId leaf, float negligible) const {
    const bool cluster = e_.isCluster(l.sender), receiverCluster = e_.isCluster(l.receiver);
    Rgb B = e_.radiometry[l.sender.index()].B;
    if (cluster) {
      const Vec3f between = e_.shape(receiverCluster ? leaf : l.receiver).center - e_.shape(l.sender).center;
      B = e_.cluster(l.sender).intensity.at(glm::normalize(between));
    }
    const bool alone = l.receiver == leaf || l.receiver == l.sender ||
                       (!receiverCluster && l.receiverSpread * gray(l.V * B) < negligible);
    return (alone ? l.K : kernelAt(l, leaf)) * l.V * B;
  }

  /// The link's kernel at a leaf: at the centre of flat ones, over the nodes of curved ones.
  float kernelAt(const Link& l, ElementId leaf) const {
    const ElementGeometry& g = e_.shape(leaf);
    double K = 0;
    if (e_.at(leaf).flat) {
      K = kernelAtPoint(e_, s_.scene, g.center, g.normal, l.sender);
    } else {
      const ElementNodes& n = e_.nodes[leaf.index()];
      for (int i = 0; i < 4; ++i)
        if (n.weight[i] > 0) K += n.weight[i] * kernelAtPoint(e_, s_.scene, n.position[i], n.normal[i], l.sender);
    }
    return std::min(static_cast<float>(K), kMostGain * l.K);
  }

  const Solution& s_;
  const Elements& e_;
  std::vector<std::uint32_t> begin_;  // per receiver, one more
  std::vector<LinkId> links_;
};

}  // namespace

std::vector<LeafIrradiance> gatherAtLeaves(const Solution& s) {
  const LeafGather gather(s);
  std::vector<LeafIrradiance> values(s.elements.size());
  parallelFor(values.size(), kBlock, [&](std::size_t i) {
    if (!isReceivingLeaf(s.elements, ElementId(i))) return;
    const ElementLight& l = s.elements.radiometry[i];
    values[i] = {l.direct, gather.indirectAt(ElementId(i)) + l.particle};
  });
  return values;
}

}  // namespace deltalux
