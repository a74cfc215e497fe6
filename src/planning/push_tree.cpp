#include "push_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr double kBucket_m = 0.4;  // A handful of nodes in each bucket of a full tree.

}  // namespace

PushTree::PushTree(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double rho_m,
                   double spacing_m, int case_count)
    : rho_m_(rho_m),
      cells_per_m_(1.0 / spacing_m),
      cells_per_rad_(rho_m / spacing_m),
      case_count_(case_count),
      words_((case_count + kBits - 1) / kBits),
      open_(min_m, max_m, rho_m, kBucket_m) {
  CASEPUSH_CHECK(spacing_m > 0.0 && case_count > 0, spacing_m << ", " << case_count << " cases");
  constexpr std::size_t kMostly = 64;  // Nodes of a search that soon finds its goal.
  nodes_.reserve(kMostly);
  cases_.reserve(kMostly * words_);
}

void PushTree::clear() {
  nodes_.clear();
  cases_.clear();
  cheapest_.clear();
  open_.clear();
}

int PushTree::add(const PushNode& node, bool grows) {
  const int id = size();
  if (grows) {
    const CellTable::Entry own{cell(node.map_T_object), static_cast<float>(node.cost_s), id};
    if (CellTable::Entry* const entry = cheapest_.find(own.cell)) {
      if (entry->cost_s <= own.cost_s) {
        return -1;
      }
      close(entry->node);
      *entry = own;
    } else {
      cheapest_.add(own);
    }
  }
  nodes_.push_back({node, case_count_, State::kClosed, grows});
  cases_.resize(cases_.size() + words_);
  if (case_count_ % kBits != 0) {
    cases_.back().untried = (std::uint64_t{1} << (case_count_ % kBits)) - 1;
  }
  if (grows) {
    openNode(id);
  }
  return id;
}

void PushTree::markTried(int id, int push) {
  CASEPUSH_CHECK(!isTried(id, push), "node " << id << ", case " << push);
  cases_[wordOf(id, push)].untried &= ~(std::uint64_t{1} << (push % kBits));
  if (--nodes_[id].untried == 0) {
    close(id);
  }
}

void PushTree::markPostponed(int id, int push) {
  markTried(id, push);
  cases_[wordOf(id, push)].postponed |= std::uint64_t{1} << (push % kBits);
}

void PushTree::openNode(int id) {
  nodes_[id].state = State::kOpen;
  open_.insert(id, nodes_[id].node.map_T_object);
}

void PushTree::close(int id) {
  if (!isOpen(id)) return;
  nodes_[id].state = State::kClosed;
  open_.remove(id, nodes_[id].node.map_T_object);
}

int PushTree::nearestOpen(const Pose2& pose) const {
  constexpr int kFew = 64;  // So few are faster to look through than empty buckets are.
  if (size() > kFew) return open_.nearest(pose);
  std::pair<double, int> best{std::numeric_limits<double>::infinity(), -1};
  for (int id = 0; id < size(); ++id) {
    if (!isOpen(id)) continue;
    best = std::min(best, {squaredPoseDistance(nodes_[id].node.map_T_object, pose, rho_m_), id});
  }
  return best.second;
}

void PushTree::removeLeaf(int id) {
  close(id);
  nodes_[id].state = State::kRemoved;
  const std::uint64_t own = cell(nodes_[id].node.map_T_object);
  const CellTable::Entry* const entry = cheapest_.find(own);
  if (entry != nullptr && entry->node == id) cheapest_.erase(own);
}

void PushTree::removeSubtree(int id) {
  close(id);
  nodes_[id].state = State::kRemoved;
  for (int child = id + 1; child < size(); ++child) {  // Parents come before their children.
    const int parent = nodes_[child].node.parent;
    if (parent != PushNode::kRoot && isRemoved(parent)) {
      close(child);
      nodes_[child].state = State::kRemoved;
    }
  }
  reopenAll();
}

void PushTree::reopenAll() {
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    nodes_[i / words_].untried += __builtin_popcountll(cases_[i].postponed);
    cases_[i].untried |= cases_[i].postponed;
    cases_[i].postponed = 0;
  }
  cheapest_.clear();
  for (int id = 0; id < size(); ++id) {
    if (isRemoved(id) || !nodes_[id].grows) {
      continue;
    }
    const CellTable::Entry own{cell(nodes_[id].node.map_T_object),
                               static_cast<float>(nodes_[id].node.cost_s), id};
    CellTable::Entry* const entry = cheapest_.find(own.cell);
    if (entry == nullptr) {
      cheapest_.add(own);
    } else if (own.cost_s < entry->cost_s) {
      *entry = own;
    }
  }
  for (int id = 0; id < size(); ++id) {
    if (isRemoved(id) || !nodes_[id].grows) {
      continue;
    }
    const bool is_cheapest = cheapest_.find(cell(nodes_[id].node.map_T_object))->node == id;
    const bool is_open = is_cheapest && nodes_[id].untried > 0;
    if (is_open && !isOpen(id)) {
      openNode(id);
    } else if (!is_open) {
      close(id);
    }
  }
}

}  // namespace casepush
