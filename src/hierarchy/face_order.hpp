#pragma once
// Fine meshes: the order of a mesh's faces in which any patch of many faces is a range, and parts of it are ranges
// again, like the nodes of a bounding-volume hierarchy over a space-filling curve [Lauterbach09]. Faces are split by
// which way they look first, then by where they lie, so that sides of a thin shape do not share a patch.
// Cost: a sort of the faces; 28 bytes a face.
#include <deltalux/scene.hpp>
#include <vector>

namespace deltalux::hierarchy {

/// Neighbours in the order.
struct FaceRange {
  std::uint32_t first = 0, count = 0;

  bool operator==(const FaceRange&) const = default;
};

class FaceOrder {
 public:
  FaceOrder(PrimitiveId, const Mesh&);

  PrimitiveId primitive() const { return primitive_; }
  std::uint32_t faces() const { return static_cast<std::uint32_t>(faces_.size()); }
  /// The mesh's triangle at a place of the order.
  std::uint32_t faceAt(std::uint32_t place) const { return faces_[place]; }
  std::uint32_t placeOf(std::uint32_t face) const { return places_[face]; }
  double area(const FaceRange& r) const { return areaBefore_[r.first + r.count] - areaBefore_[r.first]; }
  /// The patches of the input level: about as many however fine the mesh is, none with faces that look apart.
  std::vector<FaceRange> inputs() const;
  /// Two to four parts of a range of two faces or more, in order.
  std::vector<FaceRange> parts(const FaceRange&) const;

  /// The place below which lies the share `a` of a range's area, and what is left of that within its face, both in
  /// [0,1).
  struct Share {
    std::uint32_t place;
    double rest;
  };
  Share at(const FaceRange&, double a) const;

  std::size_t memoryBytes() const { return faces_.size() * 8 + areaBefore_.size() * 8 + codes_.size() * 8; }

 private:
  std::uint32_t middleOf(const FaceRange&) const;

  PrimitiveId primitive_;
  std::vector<std::uint32_t> faces_, places_;
  std::vector<double> areaBefore_;    // by place, and of all
  std::vector<std::uint64_t> codes_;  // by place: way, then place on the curve
};

/// Of all meshes that are fine, by primitive, as they are at rest: edits move things with the patches that they have.
std::vector<FaceOrder> faceOrders(const Scene&);

}  // namespace deltalux::hierarchy
