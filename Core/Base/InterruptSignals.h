// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_InterruptSignals_h
#define banyan_Base_InterruptSignals_h

namespace banyan
{

/// While an object of this class lives, SIGINT and SIGTERM do not end the process but are noted, so
/// that work which has files under way can end in good order. A second signal of the same kind does
/// what signals did before this class existed by default: it ends the process. Signals that the
/// process ignores stay ignored.
///
/// Several objects may live at the same time, in any threads: they note the same signals.
class InterruptSignals
{
public:
  InterruptSignals();
  /// The last object puts back what was there before the first.
  ~InterruptSignals();
  InterruptSignals(const InterruptSignals&) = delete;
  InterruptSignals& operator=(const InterruptSignals&) = delete;

  /// Whether one came since the first of the living objects was made.
  static bool Came();

  /// The signal that came last since the first object was made, or 0; remembered until there is
  /// another first object. To be raised again after the objects are gone.
  static int Last();
};

} // namespace banyan

#endif
