// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_HexWaveSimulation_h
#define banyan_Data_HexWaveSimulation_h

#include "ElasticWaveSimulation.h"
#include "HexForces.h"
#include "OctreeMesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A point source: a moment tensor whose rate is a Gaussian in time, as `MomentSource`'s. It acts
/// in the middle of the cell that its place lies in.
struct MomentPoint
{
  std::array<double, 3> Place{};  ///< metres
  std::array<double, 6> Moment{}; ///< the rate at its peak, xx, yy, zz, xy, xz, yz; N m / s
  double HalfDuration = 0.1;      ///< s; the rate is exp(-((t - Delay) / HalfDuration)^2)
  double Delay = 0.4;             ///< s; the time of the peak

  /// The moment at a time is `Moment` times this.
  double Share(double seconds) const;
};

/// What the ground does to waves beside carrying them.
struct HexWaveLosses
{
  /// Which of the block's sides let waves out: -x, +x, -y, +y, -z, +z. The others are free. Plane
  /// waves that meet a side head on are taken out altogether, others in part.
  std::array<bool, 6> OpenSides = { true, true, true, true, true, false };
  /// Rate at which the amplitude in a material falls, 1/s; may be empty: not at all.
  std::function<double(const ElasticMaterial&)> DecayRate;
};

/// Where the energy is that the sources have given, J.
struct HexWaveEnergy
{
  double Work;     ///< what the sources have done so far
  double Kinetic;  ///< of half a time step before `Time()`
  double Strain;   ///< with the above: what a step conserves exactly, but for round-off
  double Absorbed; ///< what has left through the open sides, with what the ground there has lost
};

/// Elastic waves in a block of ground on an octree mesh, with finite elements:
///
///   mass d2u/dt2 + losses du/dt + stiffness u = sources
///
/// Trilinear cubes with exact integrals, mass lumped at the nodes, central differences in time.
/// Hanging nodes carry the mean of their masters, which get their forces and masses: the solution
/// is continuous, and a deformation of constant strain is kept exactly. Open sides are dashpots of
/// Lysmer and Kuhlemeyer. The time step is 95 % of one that is proved to be stable.
///
/// Waves need about ten cells per wavelength to travel at their right speed (within 2 %). About 160
/// bytes a cell with the mesh. The same bits for any number of threads.
///
/// @par Source: Bao, Bielak, Ghattas, Kallivokas, O'Hallaron, Shewchuk, Xu (1998), Large-scale
/// simulation of elastic wave propagation in heterogeneous media on parallel computers; Bielak,
/// Ghattas, Kim (2005), Parallel octree-based finite element method for large-scale earthquake
/// ground motion simulation; Lysmer, Kuhlemeyer (1969), Finite dynamic model for infinite media.
class HexWaveSimulation
{
public:
  /// The material at a cell's middle, in metres. Called from several threads at once.
  using Ground = std::function<ElasticMaterial(const std::array<double, 3>& point)>;

  /// Everything is at rest at time 0. Throws Error when the ground is not solid everywhere or a
  /// source lies outside. The mesh is only read, and not kept.
  HexWaveSimulation(const OctreeMesh& mesh, const Ground& ground,
    const std::vector<MomentPoint>& sources, const HexWaveLosses& losses, ThreadPool& pool);

  /// Goes to the time step that is nearest to the given time, which is not before the present one.
  /// Throws Error when the waves have become infinite.
  void AdvanceTo(double seconds);

  double Time() const { return static_cast<double>(this->Steps) * this->TimeStep; }
  double TimeStepSeconds() const { return this->TimeStep; }
  std::int64_t StepsTaken() const { return this->Steps; }

  /// Metres, `[node][3]`.
  const std::vector<float>& Displacement() const { return this->U; }
  /// m/s, `[node][3]`, half a time step before `Time()`.
  const std::vector<float>& Velocity() const { return this->V; }
  /// Takes as long as a time step.
  HexWaveEnergy Energy();

private:
  /// A node in an open side: what its speed loses.
  struct OpenNode
  {
    std::uint32_t Node;
    std::array<float, 3> Loss; ///< half a time step times drag over mass
  };
  /// A force that a source has on a node, times its share.
  struct NodeForce
  {
    std::uint32_t Node, Source;
    std::array<float, 3> Force;
  };

  void SetMasses(const OctreeMesh& mesh, const std::vector<ElasticMaterial>& materials);
  void SetLosses(const OctreeMesh& mesh, const std::vector<ElasticMaterial>& materials,
    const HexWaveLosses& losses);
  void AddOpenSide(const OctreeMesh& mesh, const std::vector<ElasticMaterial>& materials, int side,
    std::vector<std::array<float, 3>>& drag) const;
  void PlaceSources(const OctreeMesh& mesh);
  void FindMasters(std::size_t nodes);
  /// Masses, losses and the like of hanging nodes go to their masters, a quarter each.
  template <typename Value>
  void GiveToMasters(std::vector<Value>& values) const;

  void Step();
  void AddSources();
  void AddHangingForces();
  double MoveNodes(std::int64_t batch);
  void InterpolateHanging();
  template <typename Body>
  void ForBatches(std::size_t count, const Body& body) const;

  ThreadPool& Pool;
  std::vector<MomentPoint> Sources;
  double TimeStep = 0.0, Work = 0.0, Absorbed = 0.0;
  std::int64_t Steps = 0;
  std::unique_ptr<HexForces> Forces;
  std::vector<float> U, V, F;    ///< displacement, velocity, force, `[node][3]`
  std::vector<float> Mass;       ///< kg; 0 for hanging nodes
  std::vector<float> Keep, Push; ///< speed after a step: Keep times that before + Push times force
  std::vector<OpenNode> OpenNodes;   ///< sorted by node
  std::vector<NodeForce> NodeForces; ///< in the order of the sources
  std::vector<MeshHangingNode> Hanging;
  std::vector<std::uint32_t> Masters;         ///< nodes that others hang on
  std::vector<std::uint32_t> MasterStart;     ///< their ranges in HangingOfMaster
  std::vector<std::uint32_t> HangingOfMaster; ///< once for each quarter
};

} // namespace banyan

#endif
