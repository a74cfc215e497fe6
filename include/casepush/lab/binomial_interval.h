#pragma once

namespace casepush {

/// Share of successes with its 95 % confidence interval (Wilson's score interval).
struct BinomialInterval {
  double share = 0.0;
  double low = 0.0;
  double high = 1.0;
};
/// @pre 0 <= successes <= trials, trials > 0.
BinomialInterval wilsonInterval(int successes, int trials);

}  // namespace casepush
