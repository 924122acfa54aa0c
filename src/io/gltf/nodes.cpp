#include "io/gltf/nodes.hpp"

#include <algorithm>
#include <deltalux/error.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

namespace deltalux::io {

namespace {

Mat4 localTransform(const tinygltf::Node& node) {
  Mat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    matrix[0][3] = matrix[1][3] = matrix[2][3] = 0, matrix[3][3] = 1;
    return matrix;
  }
  if (node.rotation.size() == 4) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (length > 0 && std::isfinite(length)) matrix = glm::mat4_cast(q / length);
  }
  for (int i = 0; i < 3 && node.scale.size() == 3; ++i) matrix[i] *= node.scale[static_cast<std::size_t>(i)];
  for (int i = 0; i < 3 && node.translation.size() == 3; ++i)
    matrix[3][i] = node.translation[static_cast<std::size_t>(i)];
  return matrix;
}

class Walk {
 public:
  explicit Walk(const GltfDocument& document) : document_(document), seen_(document.model.nodes.size(), false) {}

  void visit(int node, int parent, int depth, std::set<std::string>& namesBeside) {
    constexpr int kMaxDepth = 200;  // [limit]
    const std::string where = "/nodes/" + std::to_string(node);
    if (depth > kMaxDepth) fail(where + " is more than 200 nodes below its root");
    if (seen_[static_cast<std::size_t>(node)]) fail(where + " has two parents, or is its own ancestor");
    seen_[static_cast<std::size_t>(node)] = true;

    const tinygltf::Node& source = document_.model.nodes[static_cast<std::size_t>(node)];
    PlacedNode placed{node, parent, uniqueName(source, node, namesBeside), localTransform(source)};
    if (parent >= 0) {
      const PlacedNode& above = list[static_cast<std::size_t>(parent)];
      placed.path = above.path + "/" + placed.path;
      placed.toWorld = above.toWorld * placed.toWorld;
    }
    const int index = static_cast<int>(list.size());
    list.push_back(std::move(placed));
    std::set<std::string> childNames;
    for (const int child : source.children) visit(child, index, depth + 1, childNames);
  }

  std::vector<PlacedNode> list;

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(document_.name, 0, message, "glTF nodes form trees; export the scene again");
  }

  static std::string uniqueName(const tinygltf::Node& node, int index, std::set<std::string>& taken) {
    std::string name = node.name.empty() ? "node" + std::to_string(index) : node.name;
    std::replace(name.begin(), name.end(), '/', '_');
    const std::string first = name;
    for (int count = 2; !taken.insert(name).second; ++count) name = first + "#" + std::to_string(count);
    return name;
  }

  const GltfDocument& document_;
  std::vector<bool> seen_;
};

std::vector<int> rootsOf(const tinygltf::Model& model) {
  if (!model.scenes.empty()) return model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes;
  std::vector<bool> isChild(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) isChild[static_cast<std::size_t>(child)] = true;
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < isChild.size(); ++i) {
    if (!isChild[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

}  // namespace

std::vector<PlacedNode> placedNodes(const GltfDocument& document) {
  Walk walk(document);
  std::set<std::string> names;
  for (const int root : rootsOf(document.model)) walk.visit(root, -1, 1, names);
  return std::move(walk.list);
}

}  // namespace deltalux::io
