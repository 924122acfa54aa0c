#include "hierarchy/face_order.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/morton.hpp"
#include "base/parallel.hpp"
#include "hierarchy/tuning.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::hierarchy {

namespace {

constexpr int kBits = 20, kCurveBits = 3 * kBits;  // [layout]

/// Which of the six axes a normal is nearest to.
std::uint64_t wayOf(const Vec3& n) {
  const Vec3 a = glm::abs(n);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

std::uint64_t codeOf(const Vec3& center, const Vec3& normal, const Vec3& origin, double size) {
  const Vec3 at = glm::clamp((center - origin) / size, Vec3(0), Vec3(1)) * double((1 << kBits) - 1);
  return wayOf(normal) << kCurveBits |
         morton(static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y), static_cast<std::uint32_t>(at.z));
}

}  // namespace

FaceOrder::FaceOrder(PrimitiveId primitive, const Mesh& mesh) : primitive_(primitive) {
  constexpr std::size_t kBlock = 4096;  // [task]
  const std::size_t n = mesh.triangles.size();
  Box box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  const Vec3 extent = box.extent();
  const double size = std::max({extent.x, extent.y, extent.z, 1e-300});
  struct Coded {
    std::uint64_t code;
    std::uint32_t face;
    bool operator<(const Coded& o) const { return code != o.code ? code < o.code : face < o.face; }
  };
  std::vector<Coded> coded(n);
  parallelFor(n, kBlock, [&](std::size_t f) {
    const auto& [a, b, c] = mesh.triangles[f];
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    coded[f] = {codeOf((p + q + r) / 3.0, glm::cross(q - p, r - p), box.lower, size), static_cast<std::uint32_t>(f)};
  });
  tbb::parallel_sort(coded.begin(), coded.end());  // no two are equal
  faces_.resize(n), places_.resize(n), codes_.resize(n), areaBefore_.resize(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t f = coded[i].face;
    faces_[i] = f, places_[f] = static_cast<std::uint32_t>(i), codes_[i] = coded[i].code;
    areaBefore_[i + 1] = areaBefore_[i] + mesh.cumulativeArea[f] - (f > 0 ? mesh.cumulativeArea[f - 1] : 0.0);
  }
}

/// Where the highest bit that differs within the range is set for the first time.
std::uint32_t FaceOrder::middleOf(const FaceRange& r) const {
  const std::uint64_t differing = codes_[r.first] ^ codes_[r.first + r.count - 1];
  if (differing == 0) return r.first + r.count / 2;
  const int bit = 63 - std::countl_zero(differing);
  const auto begin = codes_.begin() + r.first;
  return r.first +
         static_cast<std::uint32_t>(
             std::partition_point(begin, begin + r.count, [&](auto code) { return !(code >> bit & 1); }) - begin);
}

std::vector<FaceRange> FaceOrder::inputs() const {
  const std::uint32_t most = std::max(faces() / tuning::kInputs, tuning::kInputs);
  std::vector<FaceRange> done, open{{0, faces()}};
  while (!open.empty()) {
    const FaceRange r = open.back();
    open.pop_back();
    if (r.count <= most && codes_[r.first] >> kCurveBits == codes_[r.first + r.count - 1] >> kCurveBits) {
      done.push_back(r);
      continue;
    }
    const std::uint32_t middle = middleOf(r);
    open.push_back({middle, r.first + r.count - middle});
    open.push_back({r.first, middle - r.first});
  }
  return done;
}

std::vector<FaceRange> FaceOrder::parts(const FaceRange& whole) const {
  std::vector<FaceRange> out;
  const auto halves = [&](const FaceRange& r, const auto& visit) {
    const std::uint32_t middle = middleOf(r);
    visit(FaceRange{r.first, middle - r.first});
    visit(FaceRange{middle, r.first + r.count - middle});
  };
  halves(whole, [&](const FaceRange& half) {
    if (half.count < 2)
      out.push_back(half);
    else
      halves(half, [&](const FaceRange& quarter) { out.push_back(quarter); });
  });
  return out;
}

FaceOrder::Share FaceOrder::at(const FaceRange& r, double a) const {
  const double wanted = areaBefore_[r.first] + a * area(r);
  const auto begin = areaBefore_.begin() + r.first + 1, end = begin + r.count;
  const auto found = std::upper_bound(begin, end, wanted);
  const auto place = static_cast<std::uint32_t>(std::min(found, end - 1) - areaBefore_.begin() - 1);
  const double before = areaBefore_[place], own = areaBefore_[place + 1] - before;
  return {place, own > 0 ? std::clamp((wanted - before) / own, 0.0, 1.0 - 0x1p-53) : 0.5};
}

std::vector<FaceOrder> faceOrders(const Scene& scene) {
  std::vector<FaceOrder> orders;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const PrimitiveId primitive(i);
    const auto* mesh = std::get_if<Mesh>(&scene::edits::restShape(scene, primitive));
    if (mesh && mesh->triangles.size() >= 2 * tuning::kInputs) orders.emplace_back(primitive, *mesh);
  }
  return orders;
}

}  // namespace deltalux::hierarchy
