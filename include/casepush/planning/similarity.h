#pragma once

#include "casepush/common/paper_similarity.h"

namespace casepush {

enum class Similarity { kMetric, kPaper };  ///< The default metric, or the paper's eq. 3.

}  // namespace casepush
