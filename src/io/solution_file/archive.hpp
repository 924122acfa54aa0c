#pragma once
// Values to bytes and back, the same description for both ways: `transfer(archive, value)` goes through scalars,
// strings, vectors, optionals and variants, and through every type that has a `members(archive, value)`. Numbers are
// stored as they lie in memory (little-endian, IEEE), so doubles and floats come back exactly.
//
// Trivially copyable structs without members() are records: their bytes, behind their size, so that a program whose
// record has another size refuses the file. A record whose meaning changes and whose size does not needs a new
// kFormatVersion (container.hpp).
#include <algorithm>
#include <array>
#include <concepts>
#include <cstring>
#include <deltalux/error.hpp>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>
#include <variant>
#include <vector>

namespace deltalux::io {

inline constexpr std::uint64_t kLargeTable = 4096;  // [layout]

/// Types whose bytes are their value.
template <class T>
inline constexpr bool kPlain = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;
template <glm::length_t n, class T, glm::qualifier q>
inline constexpr bool kPlain<glm::vec<n, T, q>> = true;
template <glm::length_t c, glm::length_t r, class T, glm::qualifier q>
inline constexpr bool kPlain<glm::mat<c, r, T, q>> = true;
template <class Tag>
inline constexpr bool kPlain<Id<Tag>> = true;
template <class T, std::size_t n>
inline constexpr bool kPlain<std::array<T, n>> = kPlain<T>;

/// First and last enumerator of an enum that is stored.
template <class T>
struct EnumRange;

template <class Archive, class T>
concept HasMembers = requires(Archive& archive, T& value) {
  members(archive, value);
};

/// Things that several values share, by type and in order of their first appearance: each is stored once.
struct SharedThings {
  std::map<std::type_index, std::vector<std::shared_ptr<const void>>> shared;
};

namespace archive_detail {

template <class>
inline constexpr bool kIsVector = false;
template <class T, class Memory>
inline constexpr bool kIsVector<std::vector<T, Memory>> = true;
template <class>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class>
inline constexpr bool kIsVariant = false;
template <class... T>
inline constexpr bool kIsVariant<std::variant<T...>> = true;
template <class>
inline constexpr bool kIsShared = false;
template <class T>
inline constexpr bool kIsShared<std::shared_ptr<const T>> = true;

}  // namespace archive_detail

template <class Archive, class T>
void transfer(Archive& archive, T& value);

/// A number of things that take at least one byte each.
template <class Archive>
std::uint64_t transferCount(Archive& archive, std::size_t present) {
  std::uint64_t count = present;
  transfer(archive, count);
  if constexpr (Archive::kReads) archive.require(count <= archive.left());
  return count;
}

/// The size of a record: what this program has, and what the file says.
template <class Archive>
void transferRecordSize(Archive& archive, std::size_t size) {
  auto stored = static_cast<std::uint32_t>(size);
  transfer(archive, stored);
  if constexpr (Archive::kReads) {
    if (stored != size) archive.fail("was written by another version of deltalux, with other records");
  }
}

template <class Archive, class Vector>
void transferVector(Archive& archive, Vector& v) {
  using Item = typename std::remove_const_t<Vector>::value_type;
  std::uint64_t count = transferCount(archive, v.size());
  if constexpr (std::is_trivially_copyable_v<Item> && !HasMembers<Archive, Item>) {
    transferRecordSize(archive, sizeof(Item));
    if constexpr (Archive::kReads) {
      archive.require(count <= archive.left() / sizeof(Item));
      // Room for what edits add to large tables, so that none has to move as a whole for it.
      if (count >= kLargeTable) v.reserve(count + count / 16);
      v.resize(count);
    }
    if (count > 0) archive.bytes(v.data(), count * sizeof(Item), sizeof(Item));
  } else if constexpr (Archive::kReads) {
    v.clear();
    for (; count > 0; --count) transfer(archive, v.emplace_back());  // grows only as far as there is content
  } else {
    for (const Item& item : v) transfer(archive, item);
  }
}

template <class Archive, class Variant, std::size_t... I>
void transferVariant(Archive& archive, Variant& v, std::index_sequence<I...>) {
  auto index = static_cast<std::uint8_t>(v.index());
  transfer(archive, index);
  if constexpr (Archive::kReads) {
    archive.require(index < sizeof...(I));
    ((index == I ? static_cast<void>(v.template emplace<I>()) : void()), ...);
  }
  std::visit([&](auto& alternative) { transfer(archive, alternative); }, v);
}

template <class Archive, class Optional>
void transferOptional(Archive& archive, Optional& v) {
  bool present = v.has_value();
  transfer(archive, present);
  if constexpr (Archive::kReads) {
    if (present)
      v.emplace();
    else
      v.reset();
  }
  if (present) transfer(archive, *v);
}

template <class Archive, class Pointer>
void transferShared(Archive& archive, Pointer& v) {
  using Thing = typename std::remove_const_t<Pointer>::element_type;
  auto& shared = archive.shared[std::type_index(typeid(Thing))];
  const auto known = std::find(shared.begin(), shared.end(), v);
  auto index = static_cast<std::uint32_t>(Archive::kReads ? 0 : known - shared.begin());
  transfer(archive, index);
  const bool first = index == shared.size();
  if constexpr (Archive::kReads) {
    archive.require(index <= shared.size());
    if (first) {
      auto fresh = std::make_shared<std::remove_const_t<Thing>>();
      transfer(archive, *fresh);
      shared.push_back(std::move(fresh));
    }
    v = std::static_pointer_cast<Thing>(shared[index]);
  } else if (first) {
    shared.push_back(v);
    transfer(archive, *v);
  }
}

template <class Archive, class T>
void transfer(Archive& archive, T& value) {
  using namespace archive_detail;
  using Value = std::remove_const_t<T>;
  if constexpr (kPlain<Value>) {
    archive.bytes(&value, sizeof value);
  } else if constexpr (std::is_same_v<Value, bool>) {
    auto byte = static_cast<std::uint8_t>(value);
    transfer(archive, byte);
    if constexpr (Archive::kReads) archive.require(byte <= 1), value = byte == 1;
  } else if constexpr (std::is_enum_v<Value>) {
    auto number = static_cast<std::int32_t>(value);
    transfer(archive, number);
    if constexpr (Archive::kReads) {
      archive.require(number >= static_cast<int>(EnumRange<Value>::first) &&
                      number <= static_cast<int>(EnumRange<Value>::last));
      value = static_cast<Value>(number);
    }
  } else if constexpr (std::is_same_v<Value, std::string>) {
    const std::uint64_t count = transferCount(archive, value.size());
    if constexpr (Archive::kReads) value.resize(count);
    archive.bytes(value.data(), count);
  } else if constexpr (kIsVector<Value>) {
    transferVector(archive, value);
  } else if constexpr (kIsOptional<Value>) {
    transferOptional(archive, value);
  } else if constexpr (kIsVariant<Value>) {
    transferVariant(archive, value, std::make_index_sequence<std::variant_size_v<Value>>());
  } else if constexpr (kIsShared<Value>) {
    transferShared(archive, value);
  } else if constexpr (HasMembers<Archive, T>) {
    members(archive, value);
  } else {
    static_assert(std::is_trivially_copyable_v<Value>, "give the type a members()");
    transferRecordSize(archive, sizeof value);
    archive.bytes(&value, sizeof value);
  }
}

/// Several values in a row.
template <class Archive, class... T>
void transferAll(Archive& archive, T&... values) {
  (transfer(archive, values), ...);
}

}  // namespace deltalux::io
