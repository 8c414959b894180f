// SPDX-License-Identifier: MIT
#include "welded_peer.h"

#include <utility>

#include "peer_mesh.h"

namespace quadmark::bench {

Result<TrialMark> WeldedPeer::mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                                   const std::string& text) const {
  auto values = settingValues(text, settings());
  if (!values) return values.error();
  Work work{mesh, weld(mesh), KeyedBits(key, name(), bitCount(payload) + pilots()), std::move(*values)};
  if (const Status ok = checkMarkable(mesh, work.welded, payload); !ok) return ok.error();
  Bits written = payload.bits;
  written.resize(work.bits.count(), 0);
  for (std::size_t bit = 0; bit < written.size(); ++bit) written[bit] = work.bits.padded(bit, written[bit]) ? 1 : 0;
  std::vector<double> moved = work.welded.positions;
  TrialMark out;
  write(work, written, moved, out);
  out.positions = unwelded(mesh, work.welded, moved);
  return readableMark(*this, mesh, payload, key, text, std::move(out));
}

TrialReading WeldedPeer::read(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                              const std::string& text) const {
  auto values = settingValues(text, settings());
  if (bitCount(payload) == 0 || !values || mesh.faceCount() == 0) return {};
  const Work work{mesh, weld(mesh), KeyedBits(key, name(), bitCount(payload) + pilots()), std::move(*values)};
  BitVotes votes(work.bits);
  vote(work, votes);
  return votes.reading(bitCount(payload));
}

}  // namespace quadmark::bench
