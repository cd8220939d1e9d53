// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_Fields_SeriesInput_h
#define banyan_Testing_Core_Parallel_Fields_SeriesInput_h

#include "Base/Error.h"
#include "Parallel/Fields/DistributedField.h"
#include "Series/Decode/SeriesFile.h"

#include <memory>
#include <utility>

namespace banyan
{

/// Input of a field: a step of an encoded series of images, the whole of it on every rank.
class SeriesInput final : public FieldInput
{
public:
  int Step = 0;
  int Array = 0;
  int Component = 0;
  TemporalEnhancement Motion{ 0.0, 1.0, 0.0 };

  explicit SeriesInput(std::shared_ptr<const SeriesFile> series)
    : File(std::move(series))
  {
  }

  InputStamp Stamp() const override
  {
    InputStamp stamp;
    stamp.Add(this->File->Id());
    stamp.Add(this->Step);
    stamp.Add(this->Array);
    stamp.Add(this->Component);
    stamp.Add(this->Motion.Strength);
    stamp.Add(this->Motion.Scale);
    return stamp;
  }
  PieceFacts Facts() const override
  {
    const glm::ivec3 samples = this->File->Index().Domain.Samples();
    PieceFacts facts;
    facts.Has = PieceFacts::Kind::Image;
    facts.Deferred = 1;
    facts.Components = 1;
    facts.Step = this->Step;
    facts.Array = this->Array;
    facts.Component = this->Component;
    for (int axis = 0; axis < 3; ++axis)
    {
      facts.Hi[axis] = samples[axis];
    }
    return facts;
  }
  std::shared_ptr<const SeriesFile> Series() const override { return this->File; }
  TemporalEnhancement Enhancement() const override { return this->Motion; }
  SampleArray Samples(const glm::ivec3&) const override { throw Error("It is a series."); }
  void HideCells(const glm::ivec3&, HiddenCells&) const override {}
  double MeshTolerance() const override { return 0.0; }
  CellsField::Piece Cells() override { return {}; }
  MeshField::Piece Mesh(Communicator&, bool) override { return {}; }

private:
  std::shared_ptr<const SeriesFile> File;
};

} // namespace banyan

#endif
