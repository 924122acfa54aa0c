#pragma once
// An array nearly all of whose entries are alike: only pages that hold others are stored, so that marks on a few of
// many million things cost what the marked ones do, and a word a page. Reading takes two loads.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltalux {

template <class T>
class PagedArray {
 public:
  PagedArray() = default;
  /// `size` entries, all of them `rest`; beyond them too.
  explicit PagedArray(std::size_t size, T rest = {})
      : size_(size), rest_(rest), page_((size + kPage - 1) / kPage, 0), pool_(1, filled()) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T operator[](std::size_t i) const { return i < size_ ? pool_[page_[i / kPage]][i % kPage] : rest_; }

  /// An entry to write to. Not by several threads at once.
  T& at(std::size_t i) {
    std::uint32_t& page = page_[i / kPage];
    if (page == 0) {
      page = static_cast<std::uint32_t>(pool_.size());
      pool_.push_back(filled());
    }
    return pool_[page][i % kPage];
  }
  /// Appends entries that are `rest`.
  void grow(std::size_t size) {
    if (size <= size_) return;
    if (pool_.empty()) pool_.push_back(filled());
    size_ = size;
    page_.resize((size + kPage - 1) / kPage, 0);
  }

  /// visit(index, entry) of every entry that is not `rest`, upwards.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (std::size_t p = 0; p < page_.size(); ++p)
      if (page_[p] != 0)
        for (std::size_t i = 0; i < kPage; ++i)
          if (const T& entry = pool_[page_[p]][i]; entry != rest_) visit(p * kPage + i, entry);
  }

 private:
  static constexpr std::size_t kPage = 256;  // [task]
  using Page = std::array<T, kPage>;

  Page filled() const {
    Page page;
    page.fill(rest_);
    return page;
  }

  std::size_t size_ = 0;
  T rest_{};
  std::vector<std::uint32_t> page_;  // in the pool; 0: all are `rest`
  std::vector<Page> pool_;           // the first is that of the rest
};

}  // namespace deltalux
