// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_SeriesField_h
#define banyan_Parallel_Fields_SeriesField_h

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/DrawnField.h"
#include "Render/Bricks/ViewPrefetcher.h"
#include "Render/Steps/TemporalEnhancement.h"
#include "Series/Decode/SeriesFile.h"

#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class TimeStepPrefetcher;

/// A step of an encoded series, or values between two, which every rank reads brick by brick, in
/// zones that need not be the pieces that a reader has given it.
class SeriesField final : public DrawnField
{
public:
  /// What a rank's piece is a piece of.
  struct Piece
  {
    bool HasData = false;
    int Step = 0;
    int Array = 0;
    int Component = 0; ///< -1: Euclidean norm
    int Level = 0;
    double Fraction = 0.0; ///< see StepAndFraction
  };

  struct Wish
  {
    Box Samples; ///< of all pieces together
    LoadBalancing Balancing = LoadBalancing::Off;
    TemporalEnhancement Enhancement{ 0.0, 1.0, 0.0 };
  };

  SeriesField();
  ~SeriesField() override;

  /// Collective: takes the step that the pieces are of, if they are all of it.
  /// @param held the series of this rank's piece; null on ranks without one, which open it
  /// @param pieces of all ranks, the same on all of them; one has data at least
  /// @param wish the same on all ranks
  /// @param problem of this rank; gets what fails here, unless there is one already
  /// @return whether it is; the same on all ranks. True as well when one fails
  bool Take(Communicator& communicator, const std::shared_ptr<const SeriesFile>& held,
    const std::vector<Piece>& pieces, const Wish& wish, std::string& problem);

  void BeginFrame(Communicator& communicator, RayScene& scene) override;
  /// The time step that comes next, if it plays; otherwise what comes onto the screen, if the
  /// camera moves.
  void ReadAhead(const RayScene& scene, const Box& cells) override;
  void EndFrame(Communicator& communicator) override { this->Balancer.EndFrame(communicator); }
  void Clear() override
  {
    this->Bricks.reset();
    this->BricksBefore.reset();
  }
  BrickSource* Source() override { return this->Bricks.get(); }
  const std::vector<Box>& Zones() const override { return this->ZoneCells; }
  Place InSeries() const override;
  std::unique_ptr<BrickSource> SourceOfStep(int step) override;
  std::vector<Hash128> VisibleContent(const RayScene& scene) override;
  /// Of all steps.
  ValueRange RangeHere() override;
  Movement Moved() const override { return { this->Balancer.BytesMoved(), 0, 0, 0 }; }
  bool IsEncoded() const override { return true; }
  bool IsOnEachRank() const override { return true; }
  std::uint64_t BytesRead() const override;

private:
  /// @param cacheBytes for CacheContext::WithBudget
  void Open(const std::string& path, const std::string& fingerprint, std::int64_t cacheBytes);
  void MakeZones(const Piece& field, const Wish& wish, int ranks);

  std::shared_ptr<const SeriesFile> Series;
  FieldKey Drawn;        ///< its component is the one to draw: MakeSeriesSource
  double Fraction = 0.0; ///< towards the next step
  TemporalEnhancement Enhancement{ 0.0, 1.0, 0.0 };
  std::unique_ptr<BrickSource> Bricks;
  std::unique_ptr<BrickSource> BricksBefore; ///< of the last step, while the next one is taken
  FrameBalancer Balancer;
  std::vector<Box> ZoneCells;
  std::unique_ptr<TimeStepPrefetcher> Ahead; ///< null until something is read ahead
  ViewPrefetcher View;
};

} // namespace banyan

#endif
