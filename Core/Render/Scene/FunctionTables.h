// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_FunctionTables_h
#define banyan_Render_Scene_FunctionTables_h

#include "Render/Scene/TransferFunction.h"

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

namespace banyan
{

/// What pictures need of transfer functions, made once: a picture takes a StepTable for each of its
/// sample distances, and its probes take more, while the function stays the same from one to the
/// next.
///
/// Functions are compared entry by entry, so what comes back is always what would be made anew.
/// Methods may be called from any thread.
class FunctionTables
{
public:
  /// The tables that all pictures of this process share. Equal functions have equal ones, whatever
  /// is drawn with them, and few are kept.
  static FunctionTables& Process();

  /// StepTable(function, sampleDistance). Throws Error as it does.
  std::shared_ptr<const StepTable> StepsOf(const TransferFunction& function, double sampleDistance);

  /// VisibleValues(function). Throws Error as it does.
  std::shared_ptr<const VisibleValues> VisibleOf(const TransferFunction& function);

  /// The least recently used ones are let go beyond these numbers. With 4096 entries a table of
  /// steps takes 128 kB: 1.5 MB in all.
  static constexpr std::size_t MostFunctions = 4;
  static constexpr std::size_t MostTables = 12;

private:
  struct Tables
  {
    double Distance;
    std::shared_ptr<const StepTable> Steps;
  };
  struct Item
  {
    TransferFunction Function;
    std::shared_ptr<const VisibleValues> Visible;
    std::list<Tables> Steps; ///< the last used first
  };

  Item& ItemOf(const TransferFunction& function);
  void LetGo();

  std::list<Item> Items; ///< the last used first
  std::mutex Mutex;
};

} // namespace banyan

#endif
