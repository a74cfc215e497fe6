#pragma once

namespace casepush {

struct ChangeDetectorOptions {
  double betting = 0.3;  ///< k of the bet k p^(k-1) on each p-value, in (0, 1).
  double least_p =
      1e-3;             ///< No p-value counts as less, and no likelihood ratio as more than 1 / it.
  double alarm = 20.0;  ///< Evidence that raises it.

  void validate() const;  ///< @throws InputError naming what is out of bounds.
};

/// Notices that pushes have stopped doing what their cases say.
///
/// An e-detector (Shin, Ramdas, Rinaldo 2023): each push is a bet against the cases being right,
/// which they win on average if they are; the evidence is the product of the bets since it was last
/// at 1, as in Page's CUSUM. So false alarms are on average at least `alarm` pushes apart. Bets are
/// k p^(k-1) on the p-value of the prediction test, or, if it is known what else to expect, the
/// likelihood ratio.
class ChangeDetector {
 public:
  /// @throws InputError from the options.
  explicit ChangeDetector(const ChangeDetectorOptions& options = {});

  /// One more push with its p-value. @pre 0 <= p_value <= 1
  void add(double p_value);

  /// One more push with how much likelier it is after the change than before [nat].
  void addLogRatio(double log_ratio);

  /// One more push that says nothing.
  void addNothing();

  bool isRaised() const;

  /// How many of the latest pushes the evidence is from; the change came before the first of them.
  int pushesSinceChange() const { return pushes_; }
  void reset();

 private:
  ChangeDetectorOptions options_;
  double log_evidence_ = 0.0;
  int pushes_ = 0;
};

}  // namespace casepush
