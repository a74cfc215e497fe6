#include "casepush/model/observation.h"

namespace casepush {

const ObjectState* Observation::object(const std::string& id) const {
  for (const ObjectState& state : objects) {
    if (state.id == id) {
      return &state;
    }
  }
  return nullptr;
}

}  // namespace casepush
