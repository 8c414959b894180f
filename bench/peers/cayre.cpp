// SPDX-License-Identifier: MIT
// F. Cayre, P. Rondao-Alface, F. Schmitt, B. Macq, H. Maitre: Application of spectral decomposition to compression and
// watermarking of 3D triangle mesh geometry, Signal Processing: Image Communication 18(4), 2003, pages 309-319.
//
// The mesh is cut into patches; a patch's coordinates are projected on the eigenvectors of its combinatorial Laplacian
// (degree minus adjacency). A frequency then has three coefficients, of x, y and z. The one between the other two says the
// bit: below the middle of the outer two 0, above it 1. To write the other bit it is reflected at that middle. Reading needs
// no original, but the connectivity.
//
// The paper's text was not to be had; the above is common to its descriptions in surveys (K. Wang, G. Lavoue, F. Denis, A.
// Baskurt: A comprehensive survey on three-dimensional mesh watermarking, IEEE Transactions on Multimedia 10(8), 2008).
// Decided here:
// - Patches grow from seeds by connectivity alone (patches.h), so that noise does not change them, nor mostly reordering.
// - Before, the model is turned into its principal axes: without that a rotation would destroy the mark.
// - Eigenvectors have no sign: each gets the one that makes its largest entry positive.
// - The sense of an axis, from the third moment, may turn over on a nearly symmetric model. The reader tries all eight
//   combinations and takes the one with the clearest votes, for which sixteen more bits, always 0, are written.
// - Writing is repeated, at most four times, as a mark turns the axes a little.
// - Each bit is in many patches and frequencies. Votes are weighted by the distance from the middle: the eigenvectors are
//   orthonormal, so that noise hits all coefficients alike.
// Strength: the share of the spectrum, from the highest frequency down, that carries. Low frequencies move much and hold much.
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <unordered_map>

#include "patches.h"
#include "principal_frame.h"
#include "welded_peer.h"

namespace quadmark::bench {
namespace {

constexpr std::uint32_t kSpacing = 9;
constexpr std::size_t kSmallest = 24, kLargest = 800;  // vertices of a patch that carries
constexpr int kRounds = 4;

struct Spectrum {
  Patch patch;
  Eigen::MatrixXd basis;  // a column per frequency, ascending
};

Eigen::MatrixXd laplacianBasis(const Patch& patch, const WeldedMesh& welded) {
  const auto size = static_cast<Eigen::Index>(patch.vertices.size());
  std::unordered_map<std::uint32_t, Eigen::Index> place;
  for (Eigen::Index i = 0; i < size; ++i) place[patch.vertices[static_cast<std::size_t>(i)]] = i;
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (const std::uint32_t u : welded.neighboursOf(patch.vertices[static_cast<std::size_t>(i)])) {
      const auto found = place.find(u);
      if (found == place.end()) continue;
      laplacian(i, found->second) = -1;
      laplacian(i, i) += 1;
    }
  }
  Eigen::MatrixXd basis = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(laplacian).eigenvectors();
  for (Eigen::Index i = 0; i < size; ++i) {
    Eigen::Index largest = 0;
    basis.col(i).cwiseAbs().maxCoeff(&largest);
    if (basis(largest, i) < 0) basis.col(i) *= -1;
  }
  return basis;
}

std::vector<Spectrum> spectraOf(const WeldedMesh& welded) {
  std::vector<Spectrum> out;
  for (Patch& patch : patchesOf(welded, kSpacing)) {
    if (patch.vertices.size() < kSmallest || patch.vertices.size() > kLargest) continue;
    Eigen::MatrixXd basis = laplacianBasis(patch, welded);
    out.push_back({std::move(patch), std::move(basis)});
  }
  return out;
}

// Rows: vertices of the patch; columns: along the axes.
Eigen::MatrixX3d coordinates(const Patch& patch, const std::vector<double>& positions, const Eigen::Matrix3d& axes) {
  Eigen::MatrixX3d out(patch.vertices.size(), 3);
  for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3d> p(&positions[3 * std::size_t{patch.vertices[i]}]);
    out.row(static_cast<Eigen::Index>(i)) = (axes * p).transpose();
  }
  return out;
}

// The coefficient between the other two, and how far above their middle it is.
struct Middle {
  int axis = 0;
  double excess = 0;
};

Middle middleOf(const Eigen::RowVector3d& coefficients) {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return coefficients[a] < coefficients[b]; });
  return {order[1], coefficients[order[1]] - (coefficients[order[0]] + coefficients[order[2]]) / 2};
}

// The first frequency that carries; the lowest is the patch's place and never does.
Eigen::Index firstFrequency(const Spectrum& spectrum, double strength) {
  const Eigen::Index size = spectrum.basis.cols();
  return std::max<Eigen::Index>(1, size - static_cast<Eigen::Index>(strength * static_cast<double>(size)));
}

std::uint64_t carrier(const Spectrum& spectrum, Eigen::Index frequency) {
  return spectrum.patch.name + static_cast<std::uint64_t>(frequency);
}

class Cayre final : public WeldedPeer {
 public:
  std::string name() const override { return "cayre-spectral"; }
  PeerInfo info() const override {
    return {"F. Cayre, P. Rondao-Alface, F. Schmitt, B. Macq, H. Maitre",
            "Application of spectral decomposition to compression and watermarking of 3D triangle mesh geometry",
            "Signal Processing: Image Communication 18(4)",
            2003,
            true,
            "the order of the three spectral coefficients of a frequency of a patch",
            describe(settings()),
            "patches grow by connectivity; the model is turned into its principal axes; votes are weighted by the distance "
            "from the middle",
            "surveys' remarks: withstands noise, smoothing and similarity transforms; needs the connectivity"};
  }

 protected:
  std::vector<Setting> settings() const override { return {{"strength", 0.3, 0.01, 1}}; }

  std::size_t pilots() const override { return kPilots; }

  void write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const override {
    const std::vector<Spectrum> spectra = spectraOf(work.welded);
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::Matrix3d axes = principalAxes(moved);
      mark.carriers = 0;
      bool changed = false;
      for (const Spectrum& spectrum : spectra) {
        const Eigen::MatrixX3d coefficients = spectrum.basis.transpose() * coordinates(spectrum.patch, moved, axes);
        Eigen::MatrixX3d change = Eigen::MatrixX3d::Zero(coefficients.rows(), 3);
        for (Eigen::Index f = firstFrequency(spectrum, work.values[0]); f < coefficients.rows(); ++f) {
          const Middle middle = middleOf(coefficients.row(f));
          const bool one = work.bits.held(written, carrier(spectrum, f));
          ++mark.carriers;
          if ((middle.excess > 0) == one) continue;
          change(f, middle.axis) = -2 * middle.excess;
          changed = true;
        }
        const Eigen::MatrixX3d moves = spectrum.basis * change * axes;
        for (std::size_t i = 0; i < spectrum.patch.vertices.size(); ++i) {
          for (int axis = 0; axis < 3; ++axis)
            moved[3 * std::size_t{spectrum.patch.vertices[i]} + axis] += moves(static_cast<Eigen::Index>(i), axis);
        }
      }
      if (!changed) break;
    }
    mark.capacityBits = mark.carriers;
  }

  void vote(const Work& work, BitVotes& votes) const override {
    const std::vector<double>& positions = work.welded.positions;
    const Eigen::Matrix3d axes = principalAxes(positions);
    std::vector<BitVotes> senses(8, BitVotes(work.bits));
    for (const Spectrum& spectrum : spectraOf(work.welded)) {
      const Eigen::MatrixX3d coefficients = spectrum.basis.transpose() * coordinates(spectrum.patch, positions, axes);
      for (Eigen::Index f = firstFrequency(spectrum, work.values[0]); f < coefficients.rows(); ++f) {
        for (int sense = 0; sense < 8; ++sense) {
          const Eigen::RowVector3d turned(sense & 1 ? -1 : 1, sense & 2 ? -1 : 1, sense & 4 ? -1 : 1);
          const Middle middle = middleOf(coefficients.row(f).cwiseProduct(turned));
          senses[static_cast<std::size_t>(sense)].add(carrier(spectrum, f), middle.excess);
        }
      }
    }
    votes.add(*std::max_element(senses.begin(), senses.end(), [&](const BitVotes& a, const BitVotes& b) {
      return a.clearness() < b.clearness();
    }));
  }
};

}  // namespace

std::unique_ptr<Peer> cayreSpectral() {
  return std::make_unique<Cayre>();
}

}  // namespace quadmark::bench
