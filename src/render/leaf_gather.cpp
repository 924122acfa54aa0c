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

}  // namespace

LeafGather::LeafGather(const Solution& s) : s_(s), e_(s.elements), begin_(s.elements.size() + 1, 0) {
  for (const Link& l : s.links.all)
    if (carries(l)) ++begin_[l.receiver.index() + 1];
  for (std::size_t i = 0; i < e_.size(); ++i) begin_[i + 1] += begin_[i];
  links_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < s.links.size(); ++i)
    if (carries(s.links.all[i])) links_[next[s.links.all[i].receiver.index()]++] = LinkId(i);
}

bool LeafGather::carries(const Link& l) const {
  return l.state == LinkState::Active && l.K > 0 && !isBlack(l.V) && !e_.at(l.sender).emitter;
}

template <class KernelAt>
Rgb LeafGather::sum(ElementId leaf, float negligible, const KernelAt& kernelOf) const {
  RgbSum total(0.0);
  for (ElementId r = leaf; r.valid(); r = e_.at(r).parent) {
    const bool clusterReceiver = e_.isCluster(r);
    const Vec3f center = e_.shape(clusterReceiver ? leaf : r).center;
    for (std::uint32_t i = begin_[r.index()]; i < begin_[r.index() + 1]; ++i) {
      const Link& l = s_.links[links_[i]];
      Rgb B = e_.radiometry[l.sender.index()].B;
      if (e_.isCluster(l.sender))
        B = e_.cluster(l.sender).intensity.at(glm::normalize(center - e_.shape(l.sender).center));
      const bool varies = l.receiver != l.sender && (clusterReceiver || l.receiverSpread * gray(l.V * B) > negligible);
      const float K = varies ? std::min(static_cast<float>(kernelOf(l.sender)), kMostGain * l.K) : l.K;
      total += RgbSum(K * l.V * B);
    }
  }
  return Rgb(total);
}

Rgb LeafGather::indirectAt(ElementId leaf) const {
  const float negligible = kNegligible * gray(e_.radiometry[leaf.index()].indirect);
  const ElementGeometry& g = e_.shape(leaf);
  const ElementNodes& n = e_.nodes[leaf.index()];
  if (e_.at(leaf).flat)
    return sum(leaf, negligible, [&](ElementId s) { return kernelAtPoint(e_, s_.scene, g.center, g.normal, s); });
  return sum(leaf, negligible, [&](ElementId s) {
    double K = 0;
    for (int i = 0; i < 4; ++i)
      if (n.weight[i] > 0) K += n.weight[i] * kernelAtPoint(e_, s_.scene, n.position[i], n.normal[i], s);
    return K;
  });
}

Rgb LeafGather::indirectAt(ElementId leaf, const Vec3f& p, const Vec3f& normal) const {
  return sum(leaf, 0.0f, [&](ElementId s) { return kernelAtPoint(e_, s_.scene, p, normal, s); });
}

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
