#include "casepush/common/yaml_reader.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>
#include <system_error>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20; }

/// What comes from the file may hold line breaks; messages may not.
std::string oneLine(std::string text) {
  std::replace_if(text.begin(), text.end(), isControl, ' ');
  return text;
}

}  // namespace

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

  /// State of a reader for a map found under `name`.
  std::unique_ptr<State> nested(const std::string& name, const YAML::Node& child) const {
    auto state = std::make_unique<State>();
    state->node = child;
    state->file = file;
    state->path = path.empty() ? name : path + "." + name;
    if (!child.IsMap()) {
      throw InputError(file + ": " + state->path, "must be a map (key: value)");
    }
    return state;
  }

  template <typename Load>
  static std::unique_ptr<State> root(const std::string& name, Load load) {
    auto state = std::make_unique<State>();
    state->file = name;
    try {
      state->node = load();
    } catch (const YAML::BadFile&) {
      throw InputError(name, "cannot be read; is the path right?");
    } catch (const std::ios_base::failure&) {  // e.g. a folder
      throw InputError(name, "cannot be read; is it a file?");
    } catch (const YAML::Exception& error) {
      throw InputError(name, "is not valid YAML: " + oneLine(error.what()));
    }
    if (!state->node.IsMap()) {
      throw InputError(name, "must hold a YAML map (key: value)");
    }
    return state;
  }
};

namespace {

std::string bound(double low, double high) {
  std::ostringstream text;
  text << "must be a number in [" << low << ", " << high << "]";
  return text.str();
}

double finiteNumber(const YAML::Node& node, const std::string& where, const std::string& bounds) {
  // Not node.as<double>(): that follows the global locale, where 0.5 may not be a number.
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  const char* begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* end = text.data() + text.size();
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end) {
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
  std::error_code no_such_file;
  if (std::filesystem::exists(path, no_such_file) &&
      !std::filesystem::is_regular_file(path, no_such_file)) {
    // Not even opened: a FIFO would block.
    throw InputError(path.string(), "cannot be read; is it a file?");
  }
  return YamlReader(State::root(path.string(), [&] { return YAML::LoadFile(path.string()); }));
}

YamlReader YamlReader::fromText(const std::string& text, const std::string& name) {
  return YamlReader(State::root(name, [&] { return YAML::Load(text); }));
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
  const std::string& value = node.Scalar();
  if (std::any_of(value.begin(), value.end(), isControl)) {
    throw InputError(where(key), "must be a text on one line");
  }
  return value;
}

std::string YamlReader::block(const std::string& key) {
  const YAML::Node node = state_->get(key);
  if (!node.IsDefined() || !node.IsScalar() || node.Scalar().empty()) {
    throw InputError(where(key), "must be a non-empty block of lines");
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

std::vector<std::string> YamlReader::texts(const std::string& key) {
  const YAML::Node node = state_->get(key);
  std::vector<std::string> values;
  if (!node.IsDefined()) {
    return values;
  }
  if (!node.IsSequence()) {
    throw InputError(where(key), "must be a list of texts");
  }
  for (const YAML::Node& element : node) {
    const std::string value = element.IsScalar() ? element.Scalar() : "";
    if (value.empty() || std::any_of(value.begin(), value.end(), isControl)) {
      throw InputError(where(key), "must be a list of non-empty texts on one line each");
    }
    values.push_back(value);
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
  return YamlReader(state_->nested(key, node));
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
    readers.push_back(YamlReader(state_->nested(key + "[" + std::to_string(i) + "]", node[i])));
  }
  return readers;
}

void YamlReader::finish() const {
  std::string unknown;
  std::set<std::string> seen;
  for (const auto& entry : state_->node) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "(not a text)";
    if (state_->read.count(key) == 0) {
      unknown += (unknown.empty() ? "" : ", ") + oneLine(key);
    }
    if (!seen.insert(key).second) {
      throw InputError(where(key), "is given twice");
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
