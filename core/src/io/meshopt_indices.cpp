// SPDX-License-Identifier: MIT
// Index codec 1 (triangles by the edges and vertices that were used last) and index sequence codec 1 (differences).
#include "meshopt.h"
#include "varint_reader.h"

namespace quadmark::io {
namespace {

/// The last Size values that were pushed; slots nobody has pushed to are 0.
template <std::size_t Size>
class Recent {
 public:
  void push(std::uint32_t value) { values_[next_++ % Size] = value; }

  /// The value `back` pushes ago, 0 being the last one.
  [[nodiscard]] std::uint32_t get(std::size_t back) const { return values_[(next_ + Size - 1 - back) % Size]; }

 private:
  static_assert((Size & (Size - 1)) == 0);  // so that next_ may wrap
  std::uint32_t values_[Size] = {};
  std::uint32_t next_ = 0;
};

std::uint32_t fromZigzag(std::uint32_t value) {
  return (value & 1) != 0 ? ~(value >> 1) : value >> 1;
}

class IndexWriter {
 public:
  IndexWriter(std::uint8_t* out, std::uint32_t width) : out_(out), width_(width) {}

  void write(std::uint32_t index) {
    if (width_ == 2) {
      store(out_, static_cast<std::uint16_t>(index));
    } else {
      store(out_, index);
    }
    out_ += width_;
  }

 private:
  std::uint8_t* out_;
  std::uint32_t width_;
};

class TriangleDecoder {
 public:
  TriangleDecoder(Bytes data, Bytes pairs, IndexWriter out) : data_(data), pairs_(pairs), out_(out) {}

  /// One triangle from its code: the recent edge to grow it from, and where its third vertex comes from.
  void decode(std::uint8_t code) {
    const unsigned edge = code >> 4, source = code & 15;
    if (edge < 15) {
      const std::uint32_t a = edges_.get(2 * edge), b = edges_.get(2 * edge + 1);
      const std::uint32_t c = thirdVertex(source);
      edges_.push(b), edges_.push(c);
      edges_.push(c), edges_.push(a);
      write(a, b, c);
      return;
    }
    const unsigned pair = source < 14 ? pairs_[source] : data_.byte();
    if (source >= 14 && pair == 0) next_ = 0;  // numbering begins anew
    const std::uint32_t a = source < 15 ? next_++ : explicitVertex();
    const std::uint32_t b = pairedVertex(pair >> 4, source), c = pairedVertex(pair & 15, source);
    vertices_.push(a);
    if (isNew(pair >> 4, source)) vertices_.push(b);
    if (isNew(pair & 15, source)) vertices_.push(c);
    edges_.push(a), edges_.push(b);
    edges_.push(b), edges_.push(c);
    edges_.push(c), edges_.push(a);
    write(a, b, c);
  }

  [[nodiscard]] const VarintReader& data() const { return data_; }

 private:
  std::uint32_t explicitVertex() { return last_ += fromZigzag(data_.integer()); }

  std::uint32_t thirdVertex(unsigned source) {
    if (source > 0 && source < 13) return vertices_.get(source);
    const std::uint32_t vertex = source == 0    ? next_++
                                 : source == 13 ? --last_
                                 : source == 14 ? ++last_
                                                : explicitVertex();
    vertices_.push(vertex);
    return vertex;
  }

  /// The second and third vertex of a triangle without known edge. Only triangles with data of their own have 15.
  [[nodiscard]] static bool isNew(unsigned code, unsigned source) { return code == 0 || (code == 15 && source >= 14); }
  std::uint32_t pairedVertex(unsigned code, unsigned source) {
    if (code == 0) return next_++;
    return isNew(code, source) ? explicitVertex() : vertices_.get(code - 1);
  }

  void write(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.write(a);
    out_.write(b);
    out_.write(c);
  }

  VarintReader data_;
  Bytes pairs_;
  IndexWriter out_;
  Recent<32> edges_;  // two vertices each
  Recent<16> vertices_;
  std::uint32_t next_ = 0, last_ = 0;
};

}  // namespace

bool decodeMeshoptTriangles(Bytes stream, const MeshoptLayout& layout, std::uint8_t* out) {
  constexpr std::size_t kPairs = 16;
  const std::uint64_t triangles = layout.count / 3;
  if (layout.count % 3 != 0 || (layout.byteStride != 2 && layout.byteStride != 4)) return false;
  if (stream.size() < 1 + kPairs || stream[0] != 0xe1 || triangles > stream.size() - 1 - kPairs) return false;
  const auto codes = static_cast<std::size_t>(triangles);
  TriangleDecoder decoder(stream.subspan(1 + codes, stream.size() - 1 - codes - kPairs), stream.last(kPairs),
                          IndexWriter(out, layout.byteStride));
  for (std::size_t i = 0; i < codes; ++i) decoder.decode(stream[1 + i]);
  return decoder.data().isAtEnd();
}

bool decodeMeshoptIndices(Bytes stream, const MeshoptLayout& layout, std::uint8_t* out) {
  constexpr std::size_t kTail = 4;
  if (layout.byteStride != 2 && layout.byteStride != 4) return false;
  if (stream.size() < 1 + kTail || stream[0] != 0xd1) return false;
  VarintReader reader(stream.subspan(1, stream.size() - 1 - kTail));
  IndexWriter writer(out, layout.byteStride);
  std::uint32_t last[2] = {};  // two interleaved runs, told apart by the lowest bit
  for (std::uint64_t i = 0; i < layout.count && !reader.failed(); ++i) {
    const std::uint32_t value = reader.integer();
    writer.write(last[value & 1] += fromZigzag(value >> 1));
  }
  return reader.isAtEnd();
}

}  // namespace quadmark::io
