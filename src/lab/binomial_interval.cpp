#include "casepush/lab/binomial_interval.h"

#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"

namespace casepush {

BinomialInterval wilsonInterval(int successes, int trials) {
  CASEPUSH_CHECK(trials > 0 && successes >= 0 && successes <= trials,
                 successes << " of " << trials);
  constexpr double kZ = 1.959963984540054;  // 97.5 % quantile of the standard normal.
  const double n = trials;
  const double share = successes / n;
  const double centre = (share + kZ * kZ / (2.0 * n)) / (1.0 + kZ * kZ / n);
  const double half =
      kZ / (1.0 + kZ * kZ / n) * std::sqrt(share * (1.0 - share) / n + kZ * kZ / (4.0 * n * n));
  return {share, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace casepush
