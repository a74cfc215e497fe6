#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "casepush/cases/transfer.h"
#include "casepush/lab/learning.h"

namespace casepush {

struct TransferExperimentOptions {
  std::string from = "overbed_table";  ///< Learnt in full.
  std::string to = "utility_cart";     ///< Gets the cases of `from`.
  std::string robot = "cobot";
  int seeds = 5;           ///< Case bases learnt and transferred.
  int practices = 10;      ///< With each transferred case, looked at one after the other.
  int tests = 10;          ///< Pushes of each case that only judge.
  std::uint64_t seed = 1;  ///< First of them.
  TransferOptions transfer;
  LearningOptions learning;  ///< Of `from`; simulator, push options and floor also for `to`.

  void validate() const;  ///< @throws InputError listing every violation.
};

/// How well cases predict pushes that they have not seen, on average over cases.
struct PredictionQuality {
  double mean_error = 0.0;   ///< From the predicted to the average outcome [goal tolerances].
  double sigma_ratio = 0.0;  ///< Predicted over real standard deviation, geometric mean.
  double surprise = 0.0;     ///< -log density of an outcome, up to a constant [nat].
};

/// One seed: qualities after 0, 1, ... practices. Both ways have seen the same pushes.
struct TransferMeasures {
  int cases = 0;    ///< Transferred that push the new object.
  int useless = 0;  ///< Transferred that do not.
  std::vector<PredictionQuality> transferred;
  std::vector<PredictionQuality> scratch;  ///< [0] is empty: nothing can be predicted.
};

/// Learns `from`, proposes its cases for `to`, practises them there, and compares them after each
/// practice with cases that were learnt from those practices alone.
/// @param progress  Told what is being done.
/// @throws InputError as learnInLab; also if learning gives up or nothing can be transferred.
std::vector<TransferMeasures> transferExperiment(
    const Catalog& catalog, const TransferExperimentOptions& options,
    const std::function<void(const std::string&)>& progress = {});

}  // namespace casepush
