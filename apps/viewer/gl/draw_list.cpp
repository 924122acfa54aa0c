#include "gl/draw_list.hpp"

#include <algorithm>

namespace deltalux::viewer::gl {

void Runs::add(std::uint32_t firstIndex, std::uint32_t indices) {
  triangles += indices / 3;
  if (!counts.empty() && end_ == firstIndex) {
    counts.back() += static_cast<GLsizei>(indices);
  } else {
    counts.push_back(static_cast<GLsizei>(indices));
    offsets.push_back(reinterpret_cast<const void*>(firstIndex * sizeof(std::uint32_t)));
  }
  end_ = firstIndex + indices;
}

void Runs::draw() const {
  glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, offsets.data(),
                      static_cast<GLsizei>(counts.size()));
}

namespace {
Runs& runsOf(std::vector<DrawList::Group>& groups, TextureId texture, bool ahead) {
  const auto same = std::find_if(groups.begin(), groups.end(),
                                 [&](const DrawList::Group& g) { return g.texture == texture && g.ahead == ahead; });
  return same != groups.end() ? same->runs : groups.emplace_back(DrawList::Group{texture, ahead, {}}).runs;
}
}  // namespace

DrawList drawListOf(const MeshStore& mesh, const Eye& eye, const std::optional<Box>& section, const Ahead* ahead,
                    bool wholePanes) {
  DrawList list;
  const Scene& scene = *mesh.mesh()->scene;
  if (ahead) {
    list.ahead.assign(scene.primitives.size(), 0);
    for (const PrimitiveId p : ahead->primitives) list.ahead[p.index()] = 1;
  }
  Visibility visibility(eye, section);
  struct Pane {
    double distance;
    std::uint32_t side;
  };
  std::vector<Pane> panes;
  const std::vector<MeshStore::Side>& sides = mesh.sides();
  for (const std::uint32_t i : mesh.order()) {
    const MeshStore::Side& side = sides[i];
    const bool isAhead = list.isAhead(i);
    const Extent extent = isAhead ? moved(side.extent, ahead->matrix) : side.extent;
    if (!visibility.sees(extent)) continue;
    visibility.include(extent);
    if (side.passesOther && sides[i ^ 1].indices > 0)
      runsOf(list.behind, {}, isAhead).add(sides[i ^ 1].firstIndex, sides[i ^ 1].indices);
    if (side.seenThrough && !(wholePanes && !isClear(scene.materialOf(PrimitiveId(std::size_t{i} / 2)))))
      panes.push_back({visibility.distance(extent), i});
    else
      runsOf(list.opaque, side.texture, isAhead).add(side.firstIndex, side.indices);
  }
  std::stable_sort(panes.begin(), panes.end(), [](const Pane& a, const Pane& b) { return a.distance > b.distance; });
  for (const Pane& pane : panes) {
    DrawList::Group group{sides[pane.side].texture, list.isAhead(pane.side), {}};
    group.runs.add(sides[pane.side].firstIndex, sides[pane.side].indices);
    list.panes.push_back(std::move(group));
  }
  list.depths = visibility.depths();
  return list;
}

}  // namespace deltalux::viewer::gl
