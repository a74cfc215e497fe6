#include "casepush/lab/chain_calibration.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace casepush {
namespace {

/// Quantiles of chi-squared with three degrees of freedom.
constexpr double kHalf = 2.366;
constexpr double kNinety = 6.251;
constexpr double kNinetyFive = 7.815;

bool wasMadeAsPlanned(const PushReport& report) {
  return report.outcome == PushOutcome::kDone && report.case_id > 0;
}

/// Sums at first, shares and means in the end.
void note(const Eigen::Vector3d& deviation, const Eigen::Matrix3d& covariance,
          ChainCalibration* row) {
  const double d2 = deviation.dot(covariance.ldlt().solve(deviation));
  ++row->chains;
  row->inside_50 += d2 <= kHalf ? 1.0 : 0.0;
  row->inside_90 += d2 <= kNinety ? 1.0 : 0.0;
  row->inside_95 += d2 <= kNinetyFive ? 1.0 : 0.0;
  row->position_rms_m += deviation.head<2>().squaredNorm();
  row->yaw_rms_rad += deviation.z() * deviation.z();
}

void noteChainsFrom(const std::vector<PushReport>& reports, std::size_t first,
                    std::vector<ChainCalibration>* rows) {
  PoseGaussian expected{reports[first].map_T_start};
  for (std::size_t i = 0; i < rows->size() && first + i < reports.size(); ++i) {
    const PushReport& report = reports[first + i];
    if (!wasMadeAsPlanned(report)) return;
    expected = compound(expected, transform(report.map_T_start.inverse(), report.map_expected));
    note(logSe2(expected.mean.inverse() * report.map_T_end), expected.covariance, &(*rows)[i]);
  }
}

}  // namespace

std::vector<ChainCalibration> calibrateChains(const std::vector<std::vector<PushReport>>& tasks,
                                              int most_pushes) {
  std::vector<ChainCalibration> rows(most_pushes);
  for (const std::vector<PushReport>& reports : tasks) {
    for (std::size_t first = 0; first < reports.size(); ++first) {
      noteChainsFrom(reports, first, &rows);
    }
  }
  while (!rows.empty() && rows.back().chains == 0) rows.pop_back();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ChainCalibration& row = rows[i];
    const double share = 1.0 / row.chains;
    row.pushes = static_cast<int>(i) + 1;
    row.inside_50 *= share;
    row.inside_90 *= share;
    row.inside_95 *= share;
    row.position_rms_m = std::sqrt(share * row.position_rms_m);
    row.yaw_rms_rad = std::sqrt(share * row.yaw_rms_rad);
  }
  return rows;
}

}  // namespace casepush
