#include "casepush/ros/parameter_reader.h"

#include <ros/node_handle.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

using XmlRpc::XmlRpcValue;

std::optional<double> asNumber(XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeInt:
      return static_cast<double>(static_cast<int&>(value));
    case XmlRpcValue::TypeDouble:
      return static_cast<double&>(value);
    default:
      return std::nullopt;
  }
}

std::string asText(const XmlRpcValue& value) {
  std::ostringstream text;
  value.write(text);
  return text.str();
}

std::string numberText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string joined(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : separator) + part;
  }
  return text;
}

}  // namespace

ParameterReader::ParameterReader(XmlRpc::XmlRpcValue values, std::string name)
    // diagnostic_updater sets its period as a parameter of the node.
    : values_(std::move(values)), name_(std::move(name)), read_{"diagnostic_period"} {}

ParameterReader ParameterReader::ofNode(const ros::NodeHandle& private_handle) {
  XmlRpcValue values;
  private_handle.getParam(private_handle.getNamespace(), values);
  return ParameterReader(values, private_handle.getNamespace());
}

XmlRpcValue* ParameterReader::find(const std::string& key) {
  read_.insert(key);
  XmlRpcValue* value = &values_;
  std::istringstream path(key);
  for (std::string part; std::getline(path, part, '/');) {
    if (value->getType() != XmlRpcValue::TypeStruct || !value->hasMember(part)) {
      return nullptr;
    }
    value = &(*value)[part];
  }
  return value;
}

bool ParameterReader::has(const std::string& key) const {
  return values_.getType() == XmlRpcValue::TypeStruct && values_.hasMember(key);
}

XmlRpcValue ParameterReader::raw(const std::string& key) {
  const XmlRpcValue* value = find(key);
  return value == nullptr ? XmlRpcValue() : *value;
}

void ParameterReader::read(const std::string& key, double& value, double low, double high) {
  XmlRpcValue* given = find(key);
  if (given == nullptr) {
    return;
  }
  const std::optional<double> number = asNumber(*given);
  // Written so that NaN fails.
  if (!number || !(*number >= low && *number <= high)) {
    addViolation(key + " is " + asText(*given) + ", must be a number in [" + numberText(low) +
                 ", " + numberText(high) + "]");
    return;
  }
  value = *number;
}

void ParameterReader::read(const std::string& key, double& value) {
  XmlRpcValue* given = find(key);
  if (given == nullptr) {
    return;
  }
  const std::optional<double> number = asNumber(*given);
  if (!number || !std::isfinite(*number)) {
    addViolation(key + " is " + asText(*given) + ", must be a finite number");
    return;
  }
  value = *number;
}

void ParameterReader::read(const std::string& key, int& value, int low, int high) {
  XmlRpcValue* given = find(key);
  if (given == nullptr) {
    return;
  }
  if (given->getType() != XmlRpcValue::TypeInt || static_cast<int&>(*given) < low ||
      static_cast<int&>(*given) > high) {
    addViolation(key + " is " + asText(*given) + ", must be an integer in [" + std::to_string(low) +
                 ", " + std::to_string(high) + "]");
    return;
  }
  value = static_cast<int&>(*given);
}

void ParameterReader::read(const std::string& key, std::uint64_t& value) {
  XmlRpcValue* given = find(key);
  if (given == nullptr) {
    return;
  }
  if (given->getType() != XmlRpcValue::TypeInt || static_cast<int&>(*given) < 0) {
    addViolation(key + " is " + asText(*given) + ", must be an integer in [0, 2147483647]");
    return;
  }
  value = static_cast<std::uint64_t>(static_cast<int&>(*given));
}

void ParameterReader::read(const std::string& key, bool& value) {
  XmlRpcValue* given = find(key);
  if (given == nullptr) {
    return;
  }
  if (given->getType() != XmlRpcValue::TypeBoolean) {
    addViolation(key + " is " + asText(*given) + ", must be true or false");
    return;
  }
  value = static_cast<bool&>(*given);
}

void ParameterReader::read(const std::string& key, std::string& value) {
  XmlRpcValue* given = find(key);
  if (given == nullptr) {
    return;
  }
  if (given->getType() != XmlRpcValue::TypeString) {
    addViolation(key + " is " + asText(*given) + ", must be a string");
    return;
  }
  value = static_cast<std::string&>(*given);
}

void ParameterReader::read(const std::string& key, std::string& value,
                           const std::set<std::string>& words) {
  std::string given = value;
  read(key, given);
  if (words.count(given) == 0) {
    addViolation(key + " is '" + given + "', must be one of " +
                 joined({words.begin(), words.end()}, ", "));
    return;
  }
  value = given;
}

void ParameterReader::check(const std::function<void()>& check) {
  try {
    check();
  } catch (const InputError& error) {
    addViolation(error.what());
  }
}

void ParameterReader::collectUnknown(XmlRpcValue values, const std::string& prefix,
                                     std::vector<std::string>& unknown) const {
  if (values.getType() != XmlRpcValue::TypeStruct) {
    return;
  }
  for (auto& [key, value] : values) {
    const std::string full = prefix + key;
    if (read_.count(full) > 0) {
      continue;
    }
    const auto group = read_.lower_bound(full + "/");
    const bool is_group =
        group != read_.end() && group->compare(0, full.size() + 1, full + "/") == 0;
    if (is_group && value.getType() == XmlRpcValue::TypeStruct) {
      collectUnknown(value, full + "/", unknown);
    } else {
      unknown.push_back(full);
    }
  }
}

void ParameterReader::finish() const {
  std::vector<std::string> violations = violations_;
  std::vector<std::string> unknown;
  collectUnknown(values_, "", unknown);
  for (const std::string& key : unknown) {
    violations.push_back("unknown parameter " + key);
  }
  if (!violations.empty()) {
    throw InputError("parameters of " + name_, joined(violations, "; "));
  }
}

}  // namespace casepush
