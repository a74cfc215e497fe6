#include "casepush/common/input_error.h"
#include "casepush/world/fcl_checker.h"

namespace casepush {

struct FclChecker::Body::Data {};
struct FclChecker::Data {};

FclChecker::Body::Body(const Solid&, double) {}
FclChecker::Body::~Body() = default;
FclChecker::Body::Body(Body&&) noexcept = default;

bool FclChecker::isAvailable() { return false; }

FclChecker::FclChecker(const Map&, double) {
  throw InputError("FCL", "casepush was built without it; install libfcl-dev and build again");
}

FclChecker::~FclChecker() = default;
void FclChecker::setObstacles(const std::vector<PlacedSolid>&) {}
bool FclChecker::collides(const Body&, const Pose2&) const { return true; }

}  // namespace casepush
