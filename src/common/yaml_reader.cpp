#include "casepush/common/yaml_reader.h"

#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include <yaml-cpp/yaml.h>

#include "casepush/common/input_error.h"

namespace casepush {

struct YamlReader::State {
  YAML::Node node;
  std::string file;
  std::string path;
  std::set<std::string> read;

  YAML::Node get(const std::string& key) {
    read.insert(key);
    const YAML::Node& constant = node;
    return constant[key];
  }
};

namespace {

std::string bound(double low, double high) {
  std::ostringstream text;
  text << "must be a number in [" << low << ", " << high << "]";
  return text.str();
}

double finiteNumber(const YAML::Node& node, const std::string& where, const std::string& bounds) {
  double value = 0.0;
  try {
    value = node.as<double>();
  } catch (const YAML::Exception&) {
    throw InputError(where, "is not a number; " + bounds);
  }
  if (!std::isfinite(value)) {
    throw InputError(where, "is not finite; " + bounds);
  }
  return value;
}

}  // namespace

YamlReader::YamlReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
YamlReader::~YamlReader() = default;
YamlReader::YamlReader(YamlReader&&) noexcept = default;
YamlReader& YamlReader::operator=(YamlReader&&) noexcept = default;

YamlReader YamlReader::fromFile(const std::filesystem::path& path) {
  auto state = std::make_unique<State>();
  state->file = path.string();
  try {
    state->node = YAML::LoadFile(path.string());
  } catch (const YAML::BadFile&) {
    throw InputError(path.string(), "cannot be read; is the path right?");
  } catch (const YAML::Exception& error) {
    throw InputError(path.string(), std::string("is not valid YAML: ") + error.what());
  }
  if (!state->node.IsMap()) {
    throw InputError(path.string(), "must hold a YAML map (key: value)");
  }
  return YamlReader(std::move(state));
}

YamlReader YamlReader::fromText(const std::string& text, const std::string& name) {
  auto state = std::make_unique<State>();
  state->file = name;
  try {
    state->node = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(name, std::string("is not valid YAML: ") + error.what());
  }
  if (!state->node.IsMap()) {
    throw InputError(name, "must hold a YAML map (key: value)");
  }
  return YamlReader(std::move(state));
}

bool YamlReader::has(const std::string& key) const {
  const YAML::Node& constant = state_->node;
  return constant[key].IsDefined();
}

double YamlReader::number(const std::string& key, double low, double high) {
  const YAML::Node node = state_->get(key);
  if (!node.IsDefined()) {
    throw InputError(where(key), "is missing; " + bound(low, high));
  }
  const double value = finiteNumber(node, where(key), bound(low, high));
  if (value < low || value > high) {
    std::ostringstream text;
    text << "is " << value << "; " << bound(low, high);
    throw InputError(where(key), text.str());
  }
  return value;
}

double YamlReader::number(const std::string& key, double low, double high, double default_value) {
  return has(key) ? number(key, low, high) : default_value;
}

int YamlReader::integer(const std::string& key, int low, int high) {
  const double value = number(key, low, high);
  if (value != std::floor(value)) {
    throw InputError(where(key), "must be a whole number");
  }
  return static_cast<int>(value);
}

int YamlReader::integer(const std::string& key, int low, int high, int default_value) {
  return has(key) ? integer(key, low, high) : default_value;
}

std::string YamlReader::text(const std::string& key) {
  const YAML::Node node = state_->get(key);
  if (!node.IsDefined() || !node.IsScalar() || node.Scalar().empty()) {
    throw InputError(where(key), "must be a non-empty text");
  }
  return node.Scalar();
}

std::string YamlReader::text(const std::string& key, const std::string& default_value) {
  return has(key) ? text(key) : default_value;
}

bool YamlReader::flag(const std::string& key, bool default_value) {
  const YAML::Node node = state_->get(key);
  if (!node.IsDefined()) {
    return default_value;
  }
  try {
    return node.as<bool>();
  } catch (const YAML::Exception&) {
    throw InputError(where(key), "must be true or false");
  }
}

std::vector<double> YamlReader::numbers(const std::string& key, int count) {
  const YAML::Node node = state_->get(key);
  std::ostringstream expectation;
  expectation << "must be a list of " << (count < 0 ? std::string() : std::to_string(count) + " ")
              << "finite numbers";
  if (!node.IsDefined() || !node.IsSequence() ||
      (count >= 0 && static_cast<int>(node.size()) != count)) {
    throw InputError(where(key), expectation.str());
  }
  std::vector<double> values;
  for (const YAML::Node& element : node) {
    values.push_back(finiteNumber(element, where(key), expectation.str()));
  }
  return values;
}

YamlReader YamlReader::child(const std::string& key) {
  std::optional<YamlReader> reader = optionalChild(key);
  if (!reader) {
    throw InputError(where(key), "is missing; must be a map");
  }
  return std::move(*reader);
}

std::optional<YamlReader> YamlReader::optionalChild(const std::string& key) {
  const YAML::Node node = state_->get(key);
  if (!node.IsDefined()) {
    return std::nullopt;
  }
  if (!node.IsMap()) {
    throw InputError(where(key), "must be a map (key: value)");
  }
  auto state = std::make_unique<State>();
  state->node = node;
  state->file = state_->file;
  state->path = state_->path.empty() ? key : state_->path + "." + key;
  return YamlReader(std::move(state));
}

std::vector<YamlReader> YamlReader::children(const std::string& key) {
  const YAML::Node node = state_->get(key);
  std::vector<YamlReader> readers;
  if (!node.IsDefined()) {
    return readers;
  }
  if (!node.IsSequence()) {
    throw InputError(where(key), "must be a list of maps");
  }
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string name = key + "[" + std::to_string(i) + "]";
    if (!node[i].IsMap()) {
      throw InputError(where(name), "must be a map (key: value)");
    }
    auto state = std::make_unique<State>();
    state->node = node[i];
    state->file = state_->file;
    state->path = state_->path.empty() ? name : state_->path + "." + name;
    readers.push_back(YamlReader(std::move(state)));
  }
  return readers;
}

void YamlReader::finish() const {
  std::string unknown;
  for (const auto& entry : state_->node) {
    const std::string key = entry.first.as<std::string>();
    if (state_->read.count(key) == 0) {
      unknown += (unknown.empty() ? "" : ", ") + key;
    }
  }
  if (!unknown.empty()) {
    throw InputError(where(), "unknown key(s): " + unknown);
  }
}

std::string YamlReader::where(const std::string& key) const {
  std::string path = state_->path;
  if (!key.empty()) {
    path += (path.empty() ? "" : ".") + key;
  }
  return path.empty() ? state_->file : state_->file + ": " + path;
}

}  // namespace casepush
