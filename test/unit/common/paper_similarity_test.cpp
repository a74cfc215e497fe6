#include "casepush/common/paper_similarity.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(PaperSimilarity, isEquationThree) {
  EXPECT_NEAR(paperSimilarity(Pose2(0, 0, 0), Pose2(3, 4, 1.0471975511965976), 20.0), 2.0, 1e-12);
  EXPECT_NEAR(paperSimilarity(Pose2(1, 1, 3.1), Pose2(1, 3, 3.1), 20.0), 10.0, 1e-12);
}

TEST(PaperSimilarity, staysFiniteWhereThePrintedFormulaDoesNot) {
  EXPECT_NEAR(paperSimilarity(Pose2(1, 1, 0), Pose2(1, 1, 0), 20.0), 20000.0, 1e-6);
}

TEST(PaperSimilarity, doesNotPreferWhatIsFartherAwayPastARightAngle) {
  EXPECT_EQ(paperSimilarity(Pose2(0, 0, 0), Pose2(1, 0, 2.0), 20.0), 0.0);
  EXPECT_EQ(paperSimilarity(Pose2(0, 0, 0), Pose2(9, 0, 2.0), 20.0), 0.0);
}

}  // namespace
}  // namespace casepush
