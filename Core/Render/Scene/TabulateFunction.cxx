// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/TabulateFunction.h"

#include "Base/Error.h"

#include <algorithm>
#include <string>

namespace banyan
{
namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Parts that the way from one corner to the next is looked at in.
constexpr int Parts = 4;

double LargestDifference(const glm::dvec4& a, const glm::dvec4& b)
{
  return std::max({ std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b) });
}

/// Says what is not a number before anybody looks for an end of it.
class CheckedFunction
{
public:
  explicit CheckedFunction(const FunctionOfValue& function)
    : Function(function)
  {
  }

  glm::dvec4 operator()(double value) const
  {
    const glm::dvec4 is = this->Function(value);
    if (!std::isfinite(is.r + is.g + is.b + is.a))
    {
      throw Error("The colour or the opacity of the value " + std::to_string(value) +
                  " is not a number: look at the points of the transfer function, and whether its "
                  "range suits its scale");
    }
    return is;
  }

private:
  const FunctionOfValue& Function;
};

/// Sorted, each once, and at least two.
std::vector<double> Usable(std::vector<double> corners)
{
  const auto end = std::remove_if(
    corners.begin(), corners.end(), [](double corner) { return !std::isfinite(corner); });
  corners.erase(end, corners.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  if (corners.size() < 2)
  {
    const double low = corners.empty() ? 0.0 : corners[0];
    corners = { low, low + std::max(1.0, std::abs(low)) * 1e-6 };
  }
  return corners;
}

/// Equally spaced entries, and whether they are close enough to the function.
class EvenTable
{
public:
  /// @param aligned whether entries begin and end at the ends of equal parts of the range, not in
  ///   the middle between two of them
  EvenTable(const CheckedFunction& function, const std::vector<double>& corners, int entries,
    bool aligned = false)
    : Function(function)
    , Corners(corners)
    , Width(corners.back() - corners.front())
    , LargestStep(aligned ? LargestAlignedStep : TabulationError::Colour)
  {
    const double inset = aligned ? 0.5 * this->Width / entries : 0.0;
    this->Table.Low = corners.front() + inset;
    this->Table.High = corners.back() - inset;
    for (int i = 0; i < entries; ++i)
    {
      const double part = i / static_cast<double>(entries - 1);
      const double value = this->Table.Low * (1.0 - part) + this->Table.High * part;
      this->Exact.push_back(function(value));
      this->Table.Entries.emplace_back(this->Exact.back());
      this->Highest = std::max(this->Highest, this->Exact.back().a);
    }
    for (const double corner : corners)
    {
      this->Highest = std::max(this->Highest, function(corner).a);
    }
  }

  /// Whether a finer table may do.
  bool MayBecomeClose() const
  {
    return std::isfinite(this->Width) && std::none_of(this->Corners.begin(), this->Corners.end(),
                                           [this](double corner) { return this->JumpsAt(corner); });
  }

  bool IsClose() const
  {
    for (std::size_t i = 1; i < this->Exact.size(); ++i)
    {
      // An entry reaches half way to the next one.
      const double colour = std::max(2.0 * TabulationError::Colour, this->LargestStep);
      if (!this->AreClose(this->Exact[i - 1], this->Exact[i], colour, 2.0))
      {
        return false;
      }
    }
    for (std::size_t i = 0; i < this->Corners.size(); ++i)
    {
      const double next = this->Corners[std::min(i + 1, this->Corners.size() - 1)];
      for (int part = 0; part < Parts; ++part)
      {
        if (!this->IsCloseAt(this->Corners[i] + (next - this->Corners[i]) * part / Parts))
        {
          return false;
        }
      }
    }
    return true;
  }

  TransferFunction Take() { return std::move(this->Table); }

private:
  /// Steps this small may be off by what is rounded in float.
  static constexpr double LargestAlignedStep = 8.0 / 255.0;

  /// @param times the error of opacities that is allowed
  bool AreClose(const glm::dvec4& a, const glm::dvec4& b, double colour, double times) const
  {
    using Error = TabulationError;
    const double opacity =
      Error::OpacityOfItself * std::max(a.a, b.a) + Error::OpacityOfHighest * this->Highest;
    return LargestDifference(a, b) <= colour && std::abs(a.a - b.a) <= times * opacity;
  }

  bool IsCloseAt(double value) const
  {
    const double last = static_cast<double>(this->Exact.size()) - 1.0;
    const double width = this->Table.High - this->Table.Low;
    const double position = (value - this->Table.Low) / width * last + 0.5;
    const glm::dvec4 exact = this->Function(value);
    const auto isClose = [&](double at)
    {
      const glm::dvec4& entry =
        this->Exact[static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, last))];
      // Visible values must not be skipped.
      return this->AreClose(entry, exact, TabulationError::Colour, 1.0) &&
             (entry.a > 0.0 || exact.a <= this->Highest / 4096.0);
    };
    // Between two entries either will do.
    return isClose(position - 1e-6) || isClose(position + 1e-6);
  }

  bool JumpsAt(double corner) const
  {
    const double near = 1e-9 * this->Width;
    const glm::dvec4 at = this->Function(corner);
    for (const double beside : { corner - near, corner + near })
    {
      const glm::dvec4 other = this->Function(beside);
      const bool appears =
        (at.a > 0.0) != (other.a > 0.0) && std::abs(at.a - other.a) > 1e-6 * this->Highest;
      if (appears || !this->AreClose(at, other, this->LargestStep, 1.0))
      {
        return true;
      }
    }
    return false;
  }

  const CheckedFunction& Function;
  const std::vector<double>& Corners;
  double Width;
  double LargestStep; ///< of colours, from one entry to the next
  double Highest = 0.0;
  std::vector<glm::dvec4> Exact;
  TransferFunction Table;
};

/// Entries with edges, from the lowest value to the highest.
class AdaptiveTable
{
public:
  AdaptiveTable(const CheckedFunction& function, const std::vector<double>& corners)
    : Function(function)
    , Low(corners.front())
  {
    this->Table.Low = corners.front();
    this->Table.High = corners.back();
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      this->Highest = std::max(this->Highest, function(corners[i]).a);
      for (int part = 1; part < Parts && i + 1 < corners.size(); ++part)
      {
        this->Highest = std::max(this->Highest, function(Between(corners, i, part)).a);
      }
    }
    // Where a function ends it may round.
    const double room = 1e-6 * (0.5 * corners.back() - 0.5 * corners.front());
    const double first = corners.front() - room;
    const double last = corners.back() + room;
    this->Add({}, function(first));
    this->AddBetween(this->PointAt(first),
      this->PointAt(std::nextafter(corners.front(), -Infinity)), MostHalvings);
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      this->AddCorner(corners[i]);
      for (int part = 0; part < Parts && i + 1 < corners.size(); ++part)
      {
        const double from =
          part == 0 ? std::nextafter(corners[i], Infinity) : Between(corners, i, part);
        const double to = part + 1 == Parts ? std::nextafter(corners[i + 1], -Infinity)
                                            : Between(corners, i, part + 1);
        this->AddBetween(this->PointAt(from), this->PointAt(to), MostHalvings);
      }
    }
    this->AddBetween(
      this->PointAt(std::nextafter(corners.back(), Infinity)), this->PointAt(last), MostHalvings);
    this->Add(this->EdgeAt(last), function(last));
    if (this->Table.Entries.size() == 1)
    {
      this->Table.Edges.push_back({ corners.back(), true });
      this->Table.Entries.push_back(this->Table.Entries.front());
    }
  }

  TransferFunction Take() { return std::move(this->Table); }

private:
  struct Point
  {
    double Value;
    glm::dvec4 Is;
  };

  Point PointAt(double value) const { return { value, this->Function(value) }; }

  static constexpr int MostHalvings = 80;
  static constexpr double ColourStep = 1.0 / 255.0;
  static constexpr double OpacityStep = 1.0 / 256.0;

  static double Between(const std::vector<double>& corners, std::size_t i, int part)
  {
    const double way = part / static_cast<double>(Parts);
    return corners[i] * (1.0 - way) + corners[i + 1] * way;
  }

  /// Adds the entry that begins at an edge, unless it is the same as the one before.
  void Add(const FunctionEdge& edge, const glm::dvec4& is)
  {
    const glm::vec4 entry(is);
    if (this->Table.Entries.empty())
    {
      this->Table.Entries.push_back(entry);
    }
    else if (entry != this->Table.Entries.back())
    {
      this->Table.Edges.push_back(edge);
      this->Table.Entries.push_back(entry);
    }
  }

  /// A corner belongs to what comes before or after it, or stands alone. The next entry takes its
  /// edge from here.
  void AddCorner(double corner)
  {
    const glm::dvec4 at = this->Function(corner);
    const glm::dvec4 before = this->Function(std::nextafter(corner, -Infinity));
    const glm::dvec4 after = this->Function(std::nextafter(corner, Infinity));
    this->NextIsBehind = !this->AreClose(at, after);
    if (this->NextIsBehind && !this->AreClose(at, before))
    {
      this->Add({ corner, false }, at);
    }
    this->Corner = corner;
    this->AtCorner = true;
  }

  bool AreClose(const glm::dvec4& a, const glm::dvec4& b) const
  {
    const double most = OpacityStep * std::max(a.a, b.a) + this->Highest / 4096.0;
    const bool alike =
      (a.a > 0.0) == (b.a > 0.0) || std::abs(a.a - b.a) < 1e-3 * this->Highest / 4096.0;
    return LargestDifference(a, b) <= ColourStep && std::abs(a.a - b.a) <= most && alike;
  }

  /// Where a cell begins: an edge that the corner before it may have left behind itself.
  FunctionEdge EdgeAt(double value)
  {
    const bool first = this->AtCorner;
    this->AtCorner = false;
    return first ? FunctionEdge{ this->Corner, this->NextIsBehind } : FunctionEdge{ value, false };
  }

  bool IsNarrow(double a, double b) const
  {
    const double fromLow = std::max(std::abs(a - this->Low), std::abs(b - this->Low));
    return b - a <= 3e-8 * fromLow || b - a <= 4e-16 * std::max(std::abs(a), std::abs(b));
  }

  void AddBetween(const Point& a, const Point& b, int halvings)
  {
    if (!(a.Value < b.Value))
    {
      return;
    }
    Point middle{ 0.5 * a.Value + 0.5 * b.Value, {} };
    middle.Is = this->Function(middle.Value);
    if ((this->AreClose(a.Is, b.Is) && this->AreClose(a.Is, middle.Is) &&
          this->AreClose(middle.Is, b.Is)))
    {
      this->Add(this->EdgeAt(a.Value), middle.Is);
    }
    else if (halvings == 0 || this->IsNarrow(a.Value, b.Value))
    {
      this->AddJump(a, b);
    }
    else
    {
      this->AddBetween(a, middle, halvings - 1);
      this->AddBetween(middle, b, halvings - 1);
    }
  }

  /// To the last bit: data may have the very value.
  void AddJump(Point a, Point b)
  {
    this->Add(this->EdgeAt(a.Value), a.Is);
    for (double middle = 0.5 * a.Value + 0.5 * b.Value; middle > a.Value && middle < b.Value;
         middle = 0.5 * a.Value + 0.5 * b.Value)
    {
      const glm::dvec4 is = this->Function(middle);
      (this->AreClose(is, a.Is) ? a : b) = { middle, is };
    }
    this->Add({ b.Value, false }, b.Is);
  }

  const CheckedFunction& Function;
  double Low;
  double Highest = 0.0;
  double Corner = 0.0;
  bool AtCorner = false;
  bool NextIsBehind = false;
  TransferFunction Table;
};

} // namespace

TransferFunction TabulateFunction(
  const FunctionOfValue& unchecked, std::vector<double> corners, int equalParts, int entries)
{
  const CheckedFunction function(unchecked);
  corners = Usable(std::move(corners));
  if (equalParts > 1 && equalParts <= entries)
  {
    const int perPart = (entries + equalParts - 1) / equalParts;
    EvenTable aligned(function, corners, perPart * equalParts, true);
    if (aligned.MayBecomeClose() && aligned.IsClose())
    {
      return aligned.Take();
    }
  }
  EvenTable even(function, corners, entries);
  if (even.MayBecomeClose())
  {
    if (even.IsClose())
    {
      return even.Take();
    }
    EvenTable finer(function, corners, 4 * entries);
    if (finer.IsClose())
    {
      return finer.Take();
    }
  }
  return AdaptiveTable(function, corners).Take();
}

} // namespace banyan
