#include "casepush/lab/transfer_experiment.h"

#include <cmath>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "casepush/execution/displacement_coverage.h"
#include "push_pool.h"
#include "scratch_case_base.h"

namespace casepush {
namespace {

constexpr int kMaxFailures = 5;  // Of a case before it counts as useless.

Eigen::Vector3d errorOf(const PoseGaussian& predicted, const Pose2& outcome) {
  return logSe2(predicted.mean.inverse() * outcome);
}

/// What is measured for one case, in a form that can be averaged over cases.
struct Score {
  double mean_error = 0.0;
  double log_sigma_ratio = 0.0;
  double surprise = 0.0;
};

Score scoreOf(const PoseGaussian& predicted, const PoseGaussian& real,
              const std::vector<Pose2>& tests, const Pose2& test_mean) {
  Score score;
  score.mean_error = toleranceDistance(predicted.mean, test_mean);
  const double log_determinant = std::log(predicted.covariance.determinant());
  // Three dimensions, and a standard deviation is the root of a variance.
  score.log_sigma_ratio = (log_determinant - std::log(real.covariance.determinant())) / 6.0;
  const Eigen::Matrix3d inverse = predicted.covariance.inverse();
  for (const Pose2& outcome : tests) {
    const Eigen::Vector3d e = errorOf(predicted, outcome);
    score.surprise +=
        0.5 * (log_determinant + e.dot(inverse * e)) / static_cast<double>(tests.size());
  }
  return score;
}

void add(const Score& score, PredictionQuality& sum) {
  sum.mean_error += score.mean_error;
  sum.sigma_ratio += score.log_sigma_ratio;
  sum.surprise += score.surprise;
}

/// All outcomes of a case that is practised where it was transferred to; fewer than asked for if
/// it does not work there.
std::vector<Pose2> practise(PushPool& pool, Case push_case, int number, int pushes,
                            const LearningOptions& learning) {
  ExplorationOptions options = learning.exploration;
  options.cases = 1;
  options.practices = pushes;
  options.max_failures = kMaxFailures;
  Exploration exploration(pool.object(), pool.robot(), options);
  push_case.id = 1;
  exploration.resume({push_case});
  std::vector<Pose2> outcomes;
  while (auto trial = exploration.next()) {
    if (!trial->case_id) {
      break;
    }
    trial->serial = number;
    const PushReport report = pool.run(*trial, push_case).report;
    if (exploration.judge(*trial, report) != Exploration::Verdict::kObserve) {
      continue;
    }
    const ObservedPush push = observedPush(report);
    outcomes.push_back(push.start_T_object);
    push_case = withPush(push_case, push, push_case.effective_count, learning.floor);
    exploration.observed(push_case);
  }
  return outcomes;
}

OutcomeStatistics statisticsOf(const std::vector<Pose2>& outcomes, const CovarianceFloor& floor) {
  OutcomeStatistics statistics;
  for (const Pose2& outcome : outcomes) {
    statistics = addObservation(statistics, outcome, floor);
  }
  return statistics;
}

class Comparison {
 public:
  Comparison(const TransferExperimentOptions& options, TransferMeasures& measures)
      : options_(options), measures_(measures) {
    const auto steps = static_cast<std::size_t>(options.practices) + 1;
    measures.transferred.resize(steps);
    measures.scratch.resize(steps);
  }

  /// @pre outcomes.size() == practices + tests
  void add(const Case& proposed, const std::vector<Pose2>& outcomes) {
    const std::vector<Pose2> tests(outcomes.begin() + options_.practices, outcomes.end());
    const CovarianceFloor& floor = options_.learning.floor;
    const PoseGaussian real = statisticsOf(outcomes, floor).start_outcome;
    const Pose2 test_mean = statisticsOf(tests, floor).start_outcome.mean;
    OutcomeStatistics transferred{proposed.start_outcome, proposed.effective_count};
    OutcomeStatistics scratch;
    for (std::size_t k = 0; k < measures_.transferred.size(); ++k) {
      if (k > 0) {
        transferred = addObservation(transferred, outcomes[k - 1], floor);
        scratch = addObservation(scratch, outcomes[k - 1], floor);
        casepush::add(scoreOf(scratch.start_outcome, real, tests, test_mean), measures_.scratch[k]);
      }
      casepush::add(scoreOf(transferred.start_outcome, real, tests, test_mean),
                    measures_.transferred[k]);
    }
    ++measures_.cases;
  }

  void finish() {
    for (auto* qualities : {&measures_.transferred, &measures_.scratch}) {
      for (PredictionQuality& quality : *qualities) {
        quality.mean_error /= measures_.cases;
        quality.sigma_ratio = std::exp(quality.sigma_ratio / measures_.cases);
        quality.surprise /= measures_.cases;
      }
    }
  }

 private:
  const TransferExperimentOptions& options_;
  TransferMeasures& measures_;
};

}  // namespace

void TransferExperimentOptions::validate() const {
  constexpr int kFewestTests = 2;  // A mean of one is no mean.
  Violations violations;
  violations.require("seeds", seeds, 1, 1000);
  violations.require("practices", practices, 1, 1000);
  violations.require("tests", tests, kFewestTests, 1000);
  violations.throwIfAny("transfer experiment");
}

std::vector<TransferMeasures> transferExperiment(
    const Catalog& catalog, const TransferExperimentOptions& options,
    const std::function<void(const std::string&)>& progress) {
  options.validate();
  const ObjectModel from = catalog.object(options.from);
  const ObjectModel to = catalog.object(options.to);
  const int pushes = options.practices + options.tests;
  std::vector<TransferMeasures> all;
  for (int i = 0; i < options.seeds; ++i) {
    LearningOptions learning = options.learning;
    learning.exploration.seed = options.seed + static_cast<std::uint64_t>(i);
    learning.lab.simulator.seed = learning.exploration.seed;
    const auto tell = [&](const std::string& what) {
      if (progress) {
        progress("seed " + std::to_string(learning.exploration.seed) + ": " + what);
      }
    };
    tell("learning " + from.name);
    const std::vector<Case> known =
        learnInScratch(catalog, options.from, options.robot, learning).cases;
    const std::vector<Case> proposed = proposeCases(known, from, to, options.transfer);
    if (proposed.empty()) {
      throw InputError(from.name + " and " + to.name, "are too different to transfer cases");
    }
    learning.jobs = 1;  // The first practice changes the trajectory of those after it.
    PushPool pool(catalog, options.to, options.robot, learning);
    TransferMeasures measures;
    Comparison comparison(options, measures);
    for (std::size_t c = 0; c < proposed.size(); ++c) {
      tell("practising case " + std::to_string(c + 1) + " of " + std::to_string(proposed.size()) +
           " with " + to.name);
      const std::vector<Pose2> outcomes =
          practise(pool, proposed[c], static_cast<int>(c) + 1, pushes, learning);
      if (static_cast<int>(outcomes.size()) == pushes) {
        comparison.add(proposed[c], outcomes);
      } else {
        ++measures.useless;
      }
    }
    if (measures.cases == 0) {
      throw InputError(to.name, "is not moved by any case of " + from.name);
    }
    comparison.finish();
    all.push_back(std::move(measures));
  }
  return all;
}

}  // namespace casepush
