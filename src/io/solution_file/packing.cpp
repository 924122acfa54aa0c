#include "io/solution_file/packing.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deltalux/error.hpp>

#include "base/parallel.hpp"

namespace deltalux::io {

namespace {

constexpr std::size_t kBlock = 1 << 18;      // bytes; shorter ones deflate less, longer ones leave threads idle
constexpr std::size_t kWaiting = 64;         // blocks that are packed at once: 16 MB beside the solution
constexpr std::size_t kTrial = 1 << 13;      // bytes that tell which form of a block is shorter
constexpr double kMostBits = 6;              // a byte, above which deflating saves too little
constexpr std::size_t kMostInflated = 1032;  // times the deflated bytes: no stream holds more [zlib's documentation]
constexpr std::size_t kBlockFrame = 12;

/// Bits that each byte of a sequence takes by how frequent its values are.
class Entropy {
 public:
  void add(unsigned char value) { ++count_[value], ++all_; }
  double bits() const {
    double bits = 0;
    for (const std::uint32_t n : count_)
      if (n > 0) bits -= n * std::log2(n / all_);
    return all_ > 0 ? bits / all_ : 0.0;
  }

 private:
  std::array<std::uint32_t, 256> count_{};
  double all_ = 0;
};

/// Whether deflating them is in vain: neither values nor steps from one to the next recur, by a trial.
bool incompressible(std::string_view bytes) {
  if (bytes.size() < kTrial) return false;
  const std::string_view trial = bytes.substr((bytes.size() - kTrial) / 2, kTrial);
  Entropy values, steps;
  unsigned char before = 0;
  for (const char c : trial) {
    const auto value = static_cast<unsigned char>(c);
    values.add(value), steps.add(static_cast<unsigned char>(value - before)), before = value;
  }
  return values.bits() > kMostBits && steps.bits() > kMostBits;
}

/// `planes` parts of equal length, each deflated, or (of several) stored where that is in vain and only takes time.
std::string deflated(std::string_view bytes, std::size_t planes) {
  z_stream stream{};
  if (deflateInit(&stream, 1) != Z_OK) throw std::bad_alloc();
  constexpr std::size_t kSwitch = 64;  // bytes that a change of level may take
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())) + kSwitch * planes, '\0');
  stream.next_out = reinterpret_cast<Bytef*>(out.data()), stream.avail_out = static_cast<uInt>(out.size());
  const std::size_t length = bytes.size() / planes;
  int result = Z_OK;
  for (std::size_t plane = 0; plane < planes && result == Z_OK; ++plane) {
    const std::string_view part = bytes.substr(plane * length, plane + 1 < planes ? length : bytes.npos);
    result = deflateParams(&stream, planes > 1 && incompressible(part) ? 0 : 1, Z_DEFAULT_STRATEGY);
    if (result != Z_OK) break;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
    stream.avail_in = static_cast<uInt>(part.size());
    result = deflate(&stream, plane + 1 < planes ? Z_NO_FLUSH : Z_FINISH);
  }
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw std::bad_alloc();  // there is room, so zlib knows no other failure
  return out;
}

std::string transposed(std::string_view bytes, std::size_t stride) {
  const std::size_t count = bytes.size() / stride;
  std::string out(bytes.size(), '\0');
  for (std::size_t b = 0; b < stride; ++b)
    for (std::size_t i = 0; i < count; ++i) out[b * count + i] = bytes[i * stride + b];
  return out;
}

void appendNumber(std::string& to, std::size_t number) {
  const auto stored = static_cast<std::uint32_t>(number);
  to.append(reinterpret_cast<const char*>(&stored), sizeof stored);
}

std::size_t numberIn(std::string_view bytes, std::size_t at) {
  std::uint32_t number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

std::string packBlock(std::string_view bytes, std::size_t stride) {
  if (stride > 1) {
    const std::string_view trial = bytes.substr(0, std::max(stride, std::min(bytes.size(), kTrial) / stride * stride));
    if (deflated(trial, 1).size() <= deflated(transposed(trial, stride), 1).size()) stride = 1;
  }
  std::string packed = stride > 1 ? deflated(transposed(bytes, stride), stride) : deflated(bytes, 1);
  if (packed.size() >= bytes.size()) packed = bytes, stride = 0;
  std::string block;
  block.reserve(kBlockFrame + packed.size());
  for (const std::size_t number : {packed.size(), bytes.size(), stride}) appendNumber(block, number);
  return block += packed;
}

/// Whether the block holds what it says.
bool unpackBlock(const PackedBlock& block, char* to) {
  if (block.stride == 0) {
    std::memcpy(to, block.packed.data(), block.length);
    return true;
  }
  std::string planes(block.stride > 1 ? block.length : 0, '\0');
  char* const flat = block.stride > 1 ? planes.data() : to;
  auto length = static_cast<uLongf>(block.length);
  if (uncompress(reinterpret_cast<Bytef*>(flat), &length, reinterpret_cast<const Bytef*>(block.packed.data()),
                 static_cast<uLong>(block.packed.size())) != Z_OK ||
      length != block.length)
    return false;
  const std::size_t count = block.length / block.stride;
  if (block.stride > 1)
    for (std::size_t b = 0; b < block.stride; ++b)
      for (std::size_t i = 0; i < count; ++i) to[i * block.stride + b] = planes[b * count + i];
  return true;
}

[[noreturn]] void refusePacking(const std::string& file, const char* what) {
  throw InputError(file, 0, what, "solve the scene again");
}

}  // namespace

void Packer::bytes(const void* data, std::size_t n, std::size_t stride) {
  // Tables of a few records are not worth a block of their own.
  if (n < kTrial || stride > kTrial) stride = 1;
  std::string_view rest(static_cast<const char*>(data), n);
  if (stride != open_.stride) close(), open_.stride = stride;
  while (!rest.empty()) {
    const std::string_view now = rest.substr(0, kBlock / stride * stride - open_.bytes.size());
    open_.bytes += now;
    rest.remove_prefix(now.size());
    if (open_.bytes.size() == kBlock / stride * stride) close();
  }
}

void Packer::close() {
  if (!open_.bytes.empty()) waiting_.push_back({std::move(open_.bytes), open_.stride});
  open_.bytes.clear();
  if (waiting_.size() >= kWaiting) packWaiting();
}

void Packer::packWaiting() {
  std::vector<std::string> blocks(waiting_.size());
  parallelFor(blocks.size(), 1, [&](std::size_t i) { blocks[i] = packBlock(waiting_[i].bytes, waiting_[i].stride); });
  for (const std::string& b : blocks) packed_ += b;
  waiting_.clear();
}

std::string Packer::finish() {
  close();
  packWaiting();
  return std::move(packed_);
}

std::vector<PackedBlock> packedBlocks(std::string_view payload, const std::string& file) {
  std::vector<PackedBlock> blocks;
  while (!payload.empty()) {
    if (payload.size() < kBlockFrame) refusePacking(file, "is damaged: a block is cut short");
    const std::size_t packed = numberIn(payload, 0);
    PackedBlock block{{}, numberIn(payload, 4), numberIn(payload, 8)};
    payload.remove_prefix(kBlockFrame);
    if (packed > payload.size()) refusePacking(file, "is damaged: a block is longer than its section");
    block.packed = payload.substr(0, packed);
    payload.remove_prefix(packed);
    const bool fits = block.stride == 0 ? block.length == packed
                                        : block.length <= kBlock && block.length / kMostInflated <= packed &&
                                              block.length % block.stride == 0;
    if (!fits) refusePacking(file, "is damaged: a block cannot hold what it says");
    blocks.push_back(block);
  }
  return blocks;
}

ArchiveReader::ArchiveReader(std::string_view payload, std::string file)
    : file_(std::move(file)), blocks_(packedBlocks(payload, file_)) {
  for (const PackedBlock& b : blocks_) left_ += b.length;
}

void ArchiveReader::fail(const std::string& message) const {
  throw InputError(file_, 0, message, "solve the scene again");
}

void ArchiveReader::bytes(void* to, std::size_t n, std::size_t) {
  require(n <= left_);
  left_ -= n;
  for (char* at = static_cast<char*>(to); n > 0;) {
    if (at_ == open_.size()) {
      const std::size_t done = unpackWhole(at, n);
      at += done, n -= done;
      if (n == 0) return;
      open_.resize(blocks_[next_].length), at_ = 0;
      require(unpackBlock(blocks_[next_++], open_.data()));
    }
    const std::size_t now = std::min(n, open_.size() - at_);
    std::memcpy(at, open_.data() + at_, now);
    at += now, at_ += now, n -= now;
  }
}

std::size_t ArchiveReader::unpackWhole(char* to, std::size_t n) {
  std::vector<std::size_t> places;
  std::size_t total = 0;
  for (std::size_t b = next_; b < blocks_.size() && blocks_[b].length <= n - total; total += blocks_[b++].length)
    places.push_back(total);
  std::vector<char> whole(places.size(), 0);
  parallelFor(places.size(), 1, [&](std::size_t i) { whole[i] = unpackBlock(blocks_[next_ + i], to + places[i]); });
  require(std::find(whole.begin(), whole.end(), 0) == whole.end());
  next_ += places.size();
  return total;
}

}  // namespace deltalux::io
