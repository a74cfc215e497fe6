// What PushPlanner prepares for a map, and how it follows a map that changes.
#include "planner_data.h"

#include <utility>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr double kSweepReach_m = 4.0;  // Longer pushes are tested pose by pose.

const Map& notEmpty(const std::shared_ptr<const Map>& map) {
  CASEPUSH_CHECK(map != nullptr, "no map");
  if (map->empty()) {
    throw InputError("map", "is empty; load or scan one before planning");
  }
  return *map;
}

CollisionChecker::Area areaOf(const MapChange& change) {
  return {change.where_m.min().head<2>(), change.where_m.max().head<2>()};
}

// Those that footprints, masks and clearances depend on.
bool preparesTheSame(const PushPlannerOptions& a, const PushPlannerOptions& b) {
  return a.object_margin_m == b.object_margin_m && a.robot_margin_m == b.robot_margin_m &&
         a.mask_memory_mb == b.mask_memory_mb && a.time.drive_speed_mps == b.time.drive_speed_mps &&
         a.time.turn_rate_rps == b.time.turn_rate_rps && a.time.clearance_m == b.time.clearance_m &&
         a.time.handling_s == b.time.handling_s && a.robot_path.margin_m == b.robot_path.margin_m &&
         a.robot_path.dock_margin_m == b.robot_path.dock_margin_m &&
         a.robot_path.contact_tolerance_m == b.robot_path.contact_tolerance_m;
}

}  // namespace

PushPlanner::Data::Data(std::shared_ptr<const Map> new_map, RobotModel new_robot,
                        ObjectModels new_objects, const PushPlannerOptions& all)
    : map(std::move(new_map)),
      robot(std::move(new_robot)),
      objects(std::move(new_objects)),
      options(all),
      checker(notEmpty(map)),
      paths(robot, options.robot_path),
      robot_footprint(checker.footprint(robot.solid, options.robot_margin_m)),
      disposal(std::make_shared<Disposal>()),
      library(std::make_shared<SweepLibrary>(std::size_t{1000000} * options.mask_memory_mb)),
      approaches(std::make_shared<ApproachLibrary>(checker, robot, objects, options.robot_path)),
      case_sets(std::make_shared<CaseSetLibrary>()),
      spaces(std::make_shared<SearchSpaces>()),
      travel(std::make_shared<const ClearanceGrid>(*checker.mapColumns(), approaches->discs())),
      rooms(std::make_shared<RoomLibrary>(checker, objects)),
      scenes(std::make_shared<SceneLibrary>()) {
  for (const auto& [name, model] : objects) {
    Footprints& own = footprints[name];
    own.exact = checker.footprint(model.solid);
    own.grown = options.object_margin_m > 0.0
                    ? checker.footprint(model.solid, options.object_margin_m)
                    : own.exact;
    own.sweeps = std::make_shared<const SweepChecker>(
        checker, SweepChecker::heightClasses(checker, {own.grown, robot_footprint}), kSweepReach_m);
  }
}

void PushPlanner::Data::update(std::shared_ptr<const Map> newer,
                               const CollisionChecker::Area& changed) {
  const CollisionChecker before = checker;
  checker = before.updated(*newer, changed);
  map = std::move(newer);
  const CollisionChecker::Columns& columns = *checker.mapColumns();
  const bool fits = columns.hasSameExtent(*before.mapColumns());
  travel = std::make_shared<const ClearanceGrid>(
      fits ? travel->updated(columns, approaches->discs(), changed)
           : ClearanceGrid(columns, approaches->discs()));
  paths = paths.updated(before, checker, changed);
  rooms = rooms->updated(checker, changed);
  scenes = std::make_shared<SceneLibrary>();
  if (!fits) spaces = std::make_shared<SearchSpaces>();
  for (auto& [name, own] : footprints) {
    own.sweeps = std::make_shared<const SweepChecker>(own.sweeps->updated(checker, changed));
  }
}

SearchProblem PushPlanner::Data::problem(const PlanRequest& request,
                                         const std::vector<const Case*>& cases,
                                         const std::vector<PlacedSolid>& obstacles) const {
  const Footprints& own = footprints.at(request.object.model);
  return {request,
          cases,
          objects.at(request.object.model),
          robot,
          options,
          paths,
          obstacles,
          [this, &own](std::vector<PreparedCase>* prepared, const Patience& patience) {
            return library->attach(own.sweeps->classes(), own.grown, robot_footprint, prepared,
                                   patience);
          },
          approaches.get(),
          *travel,
          case_sets.get(),
          spaces.get(),
          disposal.get()};
}

PushPlanner::PushPlanner(std::shared_ptr<const Map> map, RobotModel robot,
                         std::map<std::string, ObjectModel> objects, PushPlannerOptions options) {
  options.validate();
  data_ = std::make_unique<Data>(std::move(map), std::move(robot), std::move(objects), options);
}

PushPlanner::PushPlanner(std::unique_ptr<Data> data) : data_(std::move(data)) {}

PushPlanner::~PushPlanner() = default;

std::unique_ptr<PushPlanner> PushPlanner::updated(
    std::shared_ptr<const Map> map, const std::optional<CollisionChecker::Area>& changed) const {
  if (notEmpty(map).resolution() != data_->map->resolution()) {
    return std::make_unique<PushPlanner>(std::move(map), data_->robot, data_->objects,
                                         data_->options);
  }
  const CollisionChecker::Area area = changed ? *changed : areaOf(map->changeSince(*data_->map));
  auto data = std::make_unique<Data>(*data_);
  data->update(std::move(map), area);
  return std::unique_ptr<PushPlanner>(new PushPlanner(std::move(data)));
}

std::unique_ptr<PushPlanner> PushPlanner::withOptions(const PushPlannerOptions& options) const {
  options.validate();
  CASEPUSH_CHECK(preparesTheSame(options, data_->options), "other margins, times or memory");
  auto data = std::make_unique<Data>(*data_);
  data->options = options;
  return std::unique_ptr<PushPlanner>(new PushPlanner(std::move(data)));
}

const PushPlannerOptions& PushPlanner::options() const { return data_->options; }

const std::shared_ptr<const Map>& PushPlanner::map() const { return data_->map; }

}  // namespace casepush
