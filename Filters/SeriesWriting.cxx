#include "SeriesWriting.h"

#include "PieceValues.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkPointData.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <sstream>

namespace banyan
{
namespace
{

/// Large enough for a network to be at full speed, small beside a step.
constexpr std::size_t MessageBytes = std::size_t{ 16 } << 20;
constexpr int MessageTag = 0x42414e; // "BAN"

/// Cuts a box into parts of at most `samples` each (at least one), the slowest axis first.
void Cut(const Box& box, std::int64_t samples, std::vector<Box>& parts)
{
  const glm::ivec3 size = box.Size();
  const int axis = size.z > 1 ? 2 : size.y > 1 ? 1 : 0;
  if (box.Count() <= samples || size[axis] < 2)
  {
    parts.push_back(box);
    return;
  }
  Box low = box;
  Box high = box;
  low.Hi[axis] = high.Lo[axis] = box.Lo[axis] + size[axis] / 2;
  Cut(low, samples, parts);
  Cut(high, samples, parts);
}

/// The parts that a rank sends, in the order in which rank 0 receives them.
std::vector<GatherPlan::Part> Messages(const GatherPlan& plan, std::size_t tupleBytes)
{
  const auto samples =
    static_cast<std::int64_t>(std::max<std::size_t>(MessageBytes / tupleBytes, 1));
  std::vector<GatherPlan::Part> messages;
  for (const GatherPlan::Part& part : plan.Parts)
  {
    std::vector<Box> boxes;
    Cut(part.Samples, samples, boxes);
    for (const Box& box : boxes)
    {
      messages.push_back({ part.Rank, box });
    }
  }
  return messages;
}

std::size_t TupleBytes(const WrittenArray& array)
{
  return SizeOf(array.Type) * array.Components.size();
}

/// The array of that name; names that VTK does not know were made from the array's place.
vtkDataArray* ArrayOf(vtkImageData* image, const std::string& name)
{
  vtkPointData* points = image->GetPointData();
  if (vtkDataArray* array = points->GetArray(name.c_str()))
  {
    return array;
  }
  const std::string prefix = "Unnamed";
  return points->GetArray(std::stoi(name.substr(prefix.size())));
}

} // namespace

SeriesWriting::SeriesWriting(WritingOrder order)
  : Order(std::move(order))
  , Input(this->Order.Producer, this->Order.Port)
{
  if (this->Order.Controller)
  {
    this->Rank = this->Order.Controller->GetLocalProcessId();
    this->Ranks = this->Order.Controller->GetNumberOfProcesses();
  }
  this->TwoPasses = this->Order.Options.Mode == ErrorBoundMode::RelativeToSeriesRange &&
                    this->Order.Options.ErrorBound > 0.0;
}

SeriesWriting::~SeriesWriting() = default;

void SeriesWriting::Run()
{
  this->AskForTimes();
  if (this->TwoPasses)
  {
    this->FirstPass();
  }
  this->SecondPass();
  this->OnRankZero([this] { this->Encoder->Finish(); });
  this->Encoder.reset();
}

//--------------------------------------------------------------------------------------------------
// Agreement

void SeriesWriting::AgreeOn(const std::string& problem) const
{
  std::vector<vtkMultiProcessStream> all(1);
  vtkMultiProcessStream mine;
  mine << problem;
  all[0] = mine;
  if (this->Ranks > 1)
  {
    this->Order.Controller->AllGather(mine, all);
  }
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    std::string theirs;
    all[rank] >> theirs;
    if (!theirs.empty())
    {
      throw Error((this->Ranks > 1 ? "Rank " + std::to_string(rank) + ": " : "") + theirs);
    }
  }
}

void SeriesWriting::OnRankZero(const std::function<void()>& action) const
{
  std::string problem;
  if (this->Rank == 0)
  {
    try
    {
      action();
    }
    catch (const std::bad_alloc&)
    {
      problem = "There is not enough memory for one step of the series.";
    }
    catch (const std::exception& error)
    {
      problem = error.what();
    }
  }
  this->AgreeOn(problem);
}

std::string SeriesWriting::Named(int step) const
{
  std::ostringstream text;
  text << "step " << step;
  if (this->HasTimes)
  {
    text << " (time " << this->Times[step] << ")";
  }
  return text.str();
}

void SeriesWriting::Report(int step, double part) const
{
  const double steps = static_cast<double>(this->Times.size());
  const double pass = (step + part) / steps;
  this->Order.Progress(!this->TwoPasses ? pass : (pass + (this->InSecondPass ? 1.0 : 0.0)) / 2.0);
}

//--------------------------------------------------------------------------------------------------
// Input

void SeriesWriting::AskForTimes()
{
  std::string problem;
  try
  {
    if (this->Order.FileName.empty())
    {
      throw Error("No file name is set for the series.");
    }
    this->Times = this->Input.Times();
    this->HasTimes = this->Order.AllSteps && !this->Times.empty();
    if (!this->HasTimes)
    {
      this->Times.assign(1, 0.0);
    }
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  this->AgreeOn(problem);
  if (this->Ranks > 1)
  {
    // Every rank asks for the steps of rank 0, so that all go through the same number of them.
    vtkMultiProcessStream stream;
    stream << static_cast<int>(this->HasTimes) << static_cast<int>(this->Times.size());
    for (const double time : this->Times)
    {
      stream << time;
    }
    this->Order.Controller->Broadcast(stream, 0);
    int hasTimes = 0;
    int steps = 0;
    stream >> hasTimes >> steps;
    this->HasTimes = hasTimes != 0;
    this->Times.resize(steps);
    for (double& time : this->Times)
    {
      stream >> time;
    }
  }
}

StepReport SeriesWriting::PullMine(int step, bool withRanges) const
{
  const bool seenBefore = this->TwoPasses && this->InSecondPass;
  vtkDataObject* data = this->Input.Pull(
    this->Rank, this->Ranks, this->HasTimes ? &this->Times[step] : nullptr, !seenBefore);
  StepReport report = ReportOf(data, *this->Order.Selection, withRanges);
  // Values that are decoded or copied on first touch are touched here, where a failure can still
  // be agreed upon.
  for (const WrittenArray& array : report.Arrays)
  {
    ArrayOf(vtkImageData::SafeDownCast(data), array.Name)->GetVoidPointer(0);
  }
  return report;
}

StepAgreement SeriesWriting::Pull(int step, bool withRanges)
{
  StepReport mine;
  try
  {
    mine = this->PullMine(step, withRanges);
  }
  catch (const std::bad_alloc&)
  {
    mine.Problem = "There is not enough memory for a piece of the input.";
  }
  catch (const std::exception& error)
  {
    mine.Problem = error.what();
  }
  mine.Aborted = this->Order.Aborted();

  std::vector<StepReport> reports{ mine };
  if (this->Ranks > 1)
  {
    vtkMultiProcessStream stream;
    mine.Save(stream);
    std::vector<vtkMultiProcessStream> streams;
    this->Order.Controller->AllGather(stream, streams);
    reports.resize(streams.size());
    for (std::size_t rank = 0; rank < streams.size(); ++rank)
    {
      reports[rank].Load(streams[rank]);
    }
  }
  StepAgreement now = Agree(reports);
  if (now.Aborted)
  {
    throw Error("Writing was interrupted at " + this->Named(step) + ".");
  }
  if (!now.Problem.empty())
  {
    throw Error("At " + this->Named(step) + ": " + now.Problem);
  }
  return now;
}

void SeriesWriting::CompareWithFirst(int step, const StepAgreement& now) const
{
  const std::string change = ChangeBetween(this->First, now);
  if (!change.empty())
  {
    throw Error("The data change at " + this->Named(step) + ": " + change +
                ". All steps of a series need the same grid and the same arrays.");
  }
}

//--------------------------------------------------------------------------------------------------
// Passes

void SeriesWriting::Remember(int step, const StepAgreement& now)
{
  if (step > 0)
  {
    this->CompareWithFirst(step, now);
    return;
  }
  this->First = now;
  if (!now.Warning.empty() && this->Rank == 0)
  {
    this->Order.Warn(now.Warning);
  }
}

void SeriesWriting::FirstPass()
{
  for (int step = 0; step < static_cast<int>(this->Times.size()); ++step)
  {
    this->Report(step, 0.0);
    const StepAgreement now = this->Pull(step, true);
    this->Remember(step, now);
    for (WrittenArray& array : this->First.Arrays)
    {
      // The same arrays, but perhaps in another order.
      const auto same = std::find_if(now.Arrays.begin(), now.Arrays.end(),
        [&](const WrittenArray& other) { return other.Name == array.Name; });
      for (std::size_t c = 0; c < array.Ranges.size(); ++c)
      {
        array.Ranges[c].Include(same->Ranges[c]);
      }
    }
  }
}

void SeriesWriting::SecondPass()
{
  this->InSecondPass = true;
  for (int step = 0; step < static_cast<int>(this->Times.size()); ++step)
  {
    this->Report(step, 0.0);
    const StepAgreement now = this->Pull(step, false);
    if (step > 0 || this->TwoPasses)
    {
      this->CompareWithFirst(step, now);
    }
    else
    {
      this->Remember(step, now);
    }
    this->OnRankZero(
      [this, step]
      {
        if (step == 0)
        {
          this->Open();
        }
      });
    this->Gather(now);
    this->OnRankZero([this, step] { this->Encode(step); });
  }
}

void SeriesWriting::Open()
{
  std::vector<ArrayDescription> descriptions;
  for (const WrittenArray& array : this->First.Arrays)
  {
    descriptions.push_back({ array.Name, array.Type, array.Components, array.Ranges });
  }
  this->Encoder = std::make_unique<SeriesEncoder>(this->Order.FileName, this->First.Whole,
    descriptions, this->Order.Options, ThreadPool::Process());
  for (const WrittenArray& array : this->First.Arrays)
  {
    if (array.Name == this->First.ActiveScalars)
    {
      this->Encoder->SetActiveScalars(array.Name);
    }
  }
}

void SeriesWriting::Encode(int step)
{
  double time = this->Times[step];
  if (!this->HasTimes)
  {
    vtkInformation* data = this->Input.Data()->GetInformation();
    time =
      data->Has(vtkDataObject::DATA_TIME_STEP()) ? data->Get(vtkDataObject::DATA_TIME_STEP()) : 0.0;
  }
  this->Encoder->SetProgress(
    [this, step](double part)
    {
      this->Report(step, part);
      return !this->Order.Aborted();
    });
  std::vector<ArrayValues> values;
  for (const void* array : this->WholeValues)
  {
    values.push_back({ array });
  }
  this->Encoder->AddStep(time, values);
}

//--------------------------------------------------------------------------------------------------
// Gathering

vtkImageData* SeriesWriting::Mine() const
{
  return vtkImageData::SafeDownCast(this->Input.Data());
}

void SeriesWriting::Gather(const StepAgreement& step)
{
  // A rank that has everything itself gives its own memory to the encoder.
  vtkImageData* mine = this->Mine();
  const bool alone = step.Plan.Parts.size() == 1 && step.Plan.Parts[0].Rank == 0;
  const std::size_t arrays = this->First.Arrays.size();
  const bool borrow = alone && this->Rank == 0 &&
                      mine->GetNumberOfPoints() == step.Whole.Extent.Count() &&
                      !mine->HasAnyBlankPoints();
  this->WholeValues.assign(arrays, nullptr);
  this->Message.resize(MessageBytes);
  this->OnRankZero(
    [&]
    {
      this->Whole.resize(arrays);
      for (std::size_t i = 0; i < arrays; ++i)
      {
        const WrittenArray& array = this->First.Arrays[i];
        vtkDataArray* values = borrow ? ArrayOf(mine, array.Name) : nullptr;
        if (values && IsOneBlock(values))
        {
          this->WholeValues[i] = values->GetVoidPointer(0);
          continue;
        }
        this->Whole[i].resize(step.Whole.Extent.Count() * TupleBytes(array));
        this->WholeValues[i] = this->Whole[i].data();
      }
    });
  for (std::size_t i = 0; i < arrays; ++i)
  {
    this->Transfer(step, i);
  }
}

void SeriesWriting::Transfer(const StepAgreement& step, std::size_t index)
{
  const WrittenArray& array = this->First.Arrays[index];
  const std::size_t tupleBytes = TupleBytes(array);
  for (const GatherPlan::Part& message : Messages(step.Plan, tupleBytes))
  {
    const auto bytes = message.Samples.Count() * static_cast<vtkIdType>(tupleBytes);
    if (this->Rank == message.Rank && !this->Borrowed(index))
    {
      this->Message.resize(std::max<std::size_t>(this->Message.size(), bytes));
      vtkImageData* mine = this->Mine();
      CopyPart(mine, ArrayOf(mine, array.Name), message.Samples, this->Message.data());
      if (this->Rank != 0)
      {
        this->Order.Controller->Send(this->Message.data(), bytes, 0, MessageTag);
      }
    }
    if (this->Rank == 0 && !this->Borrowed(index))
    {
      if (message.Rank != 0)
      {
        this->Message.resize(std::max<std::size_t>(this->Message.size(), bytes));
        this->Order.Controller->Receive(this->Message.data(), bytes, message.Rank, MessageTag);
      }
      PlacePart(this->Message.data(), message.Samples, this->Whole[index].data(), step.Whole.Extent,
        tupleBytes);
    }
  }
}

bool SeriesWriting::Borrowed(std::size_t index) const
{
  return this->Rank == 0 && this->WholeValues[index] != this->Whole[index].data();
}

} // namespace banyan
