#include "casepush/cases/change_detector.h"

#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"
#include "casepush/common/violations.h"

namespace casepush {

void ChangeDetectorOptions::validate() const {
  Violations violations;
  violations.require("betting", betting, 0.01, 0.99);
  violations.require("least_p", least_p, 1e-12, 0.5);
  violations.require("alarm", alarm, 1.1, 1e12);
  violations.throwIfAny("change detector");
}

ChangeDetector::ChangeDetector(const ChangeDetectorOptions& options) : options_(options) {
  options_.validate();
}

void ChangeDetector::add(double p_value) {
  CASEPUSH_CHECK(p_value >= 0.0 && p_value <= 1.0, "p = " << p_value);
  const double k = options_.betting;
  addLogRatio(std::log(k) + (k - 1.0) * std::log(std::max(p_value, options_.least_p)));
}

void ChangeDetector::addLogRatio(double log_ratio) {
  log_evidence_ += std::min(log_ratio, -std::log(options_.least_p));
  ++pushes_;
  if (log_evidence_ <= 0.0) {
    reset();
  }
}

void ChangeDetector::addNothing() { pushes_ += pushes_ > 0 ? 1 : 0; }

bool ChangeDetector::isRaised() const { return log_evidence_ >= std::log(options_.alarm); }

void ChangeDetector::reset() {
  log_evidence_ = 0.0;
  pushes_ = 0;
}

}  // namespace casepush
