#include "push_tree.h"

#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"
#include "pose_cell.h"

namespace casepush {
namespace {

constexpr double kBucket_m = 0.4;  // A handful of nodes in each bucket of a full tree.

}  // namespace

PushTree::PushTree(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double rho_m,
                   double spacing_m, int case_count)
    : rho_m_(rho_m),
      spacing_m_(spacing_m),
      case_count_(case_count),
      open_(min_m, max_m, rho_m, kBucket_m) {
  CASEPUSH_CHECK(spacing_m > 0.0 && case_count > 0, spacing_m << ", " << case_count << " cases");
}

void PushTree::clear() {
  nodes_.clear();
  state_.clear();
  grows_.clear();
  untried_.clear();
  open_position_.clear();
  tried_.clear();
  postponed_.clear();
  cheapest_.clear();
  open_.clear();
  open_ids_.clear();
}

std::uint64_t PushTree::cell(const Pose2& pose) const { return poseCell(pose, spacing_m_, rho_m_); }

int PushTree::add(const PushNode& node, bool grows) {
  const int id = size();
  if (grows) {
    const auto [entry, is_new] = cheapest_.try_emplace(cell(node.map_T_object), id);
    if (!is_new) {
      if (nodes_[entry->second].cost_s <= node.cost_s) {
        return -1;
      }
      close(entry->second);
      entry->second = id;
    }
  }
  nodes_.push_back(node);
  state_.push_back(State::kClosed);
  grows_.push_back(grows);
  untried_.push_back(case_count_);
  open_position_.push_back(-1);
  tried_.resize(tried_.size() + case_count_, false);
  if (grows) {
    openNode(id);
  }
  return id;
}

bool PushTree::isCovered(const Pose2& map_T_object, double cost_s) const {
  const auto entry = cheapest_.find(cell(map_T_object));
  return entry != cheapest_.end() && nodes_[entry->second].cost_s <= cost_s;
}

bool PushTree::isTried(int id, int push) const {
  return tried_[static_cast<std::size_t>(id) * case_count_ + push];
}

void PushTree::markTried(int id, int push) {
  CASEPUSH_CHECK(!isTried(id, push), "node " << id << ", case " << push);
  tried_[static_cast<std::size_t>(id) * case_count_ + push] = true;
  if (--untried_[id] == 0) {
    close(id);
  }
}

void PushTree::markPostponed(int id, int push) {
  markTried(id, push);
  postponed_.emplace_back(id, push);
}

void PushTree::openNode(int id) {
  state_[id] = State::kOpen;
  open_position_[id] = static_cast<int>(open_ids_.size());
  open_ids_.push_back(id);
  open_.insert(id, nodes_[id].map_T_object);
}

void PushTree::close(int id) {
  if (state_[id] != State::kOpen) {
    return;
  }
  state_[id] = State::kClosed;
  open_.remove(id, nodes_[id].map_T_object);
  const int position = open_position_[id];
  open_ids_[position] = open_ids_.back();
  open_position_[open_ids_[position]] = position;
  open_ids_.pop_back();
}

int PushTree::nearestOpen(const Pose2& pose) const {
  constexpr std::size_t kFew = 48;  // So few are faster to look through than empty buckets are.
  if (open_ids_.size() > kFew) return open_.nearest(pose);
  std::pair<double, int> best{std::numeric_limits<double>::infinity(), -1};
  for (const int id : open_ids_) {
    best = std::min(best, {squaredPoseDistance(nodes_[id].map_T_object, pose, rho_m_), id});
  }
  return best.second;
}

void PushTree::removeLeaf(int id) {
  close(id);
  state_[id] = State::kRemoved;
  const auto entry = cheapest_.find(cell(nodes_[id].map_T_object));
  if (entry != cheapest_.end() && entry->second == id) cheapest_.erase(entry);
}

void PushTree::removeSubtree(int id) {
  close(id);
  state_[id] = State::kRemoved;
  for (int child = id + 1; child < size(); ++child) {  // Parents come before their children.
    const int parent = nodes_[child].parent;
    if (parent != PushNode::kRoot && isRemoved(parent)) {
      close(child);
      state_[child] = State::kRemoved;
    }
  }
  reopenAll();
}

void PushTree::reopenAll() {
  for (const auto& [id, push] : postponed_) {
    tried_[static_cast<std::size_t>(id) * case_count_ + push] = false;
    ++untried_[id];
  }
  postponed_.clear();
  cheapest_.clear();
  for (int id = 0; id < size(); ++id) {
    if (isRemoved(id) || !grows_[id]) {
      continue;
    }
    const auto [entry, is_new] = cheapest_.try_emplace(cell(nodes_[id].map_T_object), id);
    if (!is_new && nodes_[id].cost_s < nodes_[entry->second].cost_s) {
      entry->second = id;
    }
  }
  for (int id = 0; id < size(); ++id) {
    if (isRemoved(id) || !grows_[id]) {
      continue;
    }
    const bool is_open = untried_[id] > 0 && cheapest_.at(cell(nodes_[id].map_T_object)) == id;
    if (is_open && state_[id] != State::kOpen) {
      openNode(id);
    } else if (!is_open) {
      close(id);
    }
  }
}

}  // namespace casepush
