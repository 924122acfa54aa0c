#include "paper/gather.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace deltalux::paper {

GatherPlan::GatherPlan(const hierarchy::Links& links, const hierarchy::Elements& elements) {
  // Counting sort by receiver, direct senders first; links keep their order within.
  std::vector<std::uint32_t> direct(elements.size() + 1, 0), indirect(elements.size() + 1, 0);
  for (const hierarchy::Link& l : links.all)
    if (bringsLight(l)) ++(elements.at(l.sender).emitter ? direct : indirect)[l.receiver.index()];
  std::uint32_t total = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::uint32_t d = direct[e], i = indirect[e];
    if (d + i > 0) {
      receivers_.push_back(hierarchy::ElementId(e));
      begin_.push_back(total);
      split_.push_back(total + d);
    }
    direct[e] = total;
    indirect[e] = total + d;
    total += d + i;
  }
  begin_.push_back(total);
  transfers_.resize(total);
  for (const hierarchy::Link& l : links.all) {
    if (!bringsLight(l)) continue;
    auto& next = (elements.at(l.sender).emitter ? direct : indirect)[l.receiver.index()];
    transfers_[next++] = {l.sender, l.K * l.V};
  }
}

void GatherPlan::gatherDirect(hierarchy::Elements& elements) const { gather(elements, true); }
void GatherPlan::gatherIndirect(hierarchy::Elements& elements) const { gather(elements, false); }

void GatherPlan::gather(hierarchy::Elements& elements, bool direct) const {
  // An element whose links were all refined away since the last plan must not keep what they brought.
  for (hierarchy::ElementLight& l : elements.radiometry) (direct ? l.directGathered : l.indirectGathered) = Rgb(0.0f);
  for (hierarchy::ClusterLight& c : elements.clusters) (direct ? c.directGathered : c.indirectGathered) = {};
  parallelFor(receivers_.size(), 64, [&](std::size_t i) {
    const hierarchy::ElementId r = receivers_[i];
    const std::uint32_t first = direct ? begin_[i] : split_[i], last = direct ? split_[i] : begin_[i + 1];
    const Vec3f center = elements.shape(r).center;
    const bool clusterReceiver = elements.isCluster(r);
    Rgb sum(0.0f);
    hierarchy::DirectionalRgb field;
    for (std::uint32_t k = first; k < last; ++k) {
      const Transfer& t = transfers_[k];
      const bool distant = elements.isDistant(t.sender);
      Rgb E = t.T;
      Vec3f w(0.0f);
      if (clusterReceiver || elements.isCluster(t.sender))
        w = distant ? elements.shape(t.sender).center : glm::normalize(elements.shape(t.sender).center - center);
      E *= elements.isCluster(t.sender) ? elements.cluster(t.sender).intensity.at(-w)
                                        : elements.radiometry[t.sender.index()].B;
      if (clusterReceiver)
        field.addLobe(w, E);
      else
        sum += E;
    }
    if (clusterReceiver)
      (direct ? elements.cluster(r).directGathered : elements.cluster(r).indirectGathered) = field;
    else
      (direct ? elements.radiometry[r.index()].directGathered : elements.radiometry[r.index()].indirectGathered) = sum;
  });
}

}  // namespace deltalux::paper
