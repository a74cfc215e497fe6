#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace ros {
class NodeHandle;
}

namespace casepush {

/// Reads the private parameters of a node strictly. Violations are collected; `finish()` throws
/// them all in one message, together with every parameter that nobody read.
class ParameterReader {
 public:
  /// @param name  Of the node, for messages.
  ParameterReader(XmlRpc::XmlRpcValue values, std::string name);
  /// All private parameters of this node. @pre ros::init was called and the master is up.
  static ParameterReader ofNode(const ros::NodeHandle& private_handle);

  /// Each leaves `value` as it is if the parameter is absent or wrong. A key may be "group/key".
  void read(const std::string& key, double& value, double low, double high);
  void read(const std::string& key, double& value);  ///< Any finite number.
  void read(const std::string& key, int& value, int low, int high);
  void read(const std::string& key, std::uint64_t& value);  ///< A seed: an integer of at least 0.
  void read(const std::string& key, bool& value);
  void read(const std::string& key, std::string& value);
  /// One of the words.
  void read(const std::string& key, std::string& value, const std::set<std::string>& words);

  bool has(const std::string& key) const;
  /// The raw value under a top-level key, counted as read; invalid if absent.
  XmlRpc::XmlRpcValue raw(const std::string& key);

  /// Adds the message of an InputError that `check` throws to the violations.
  void check(const std::function<void()>& check);
  void addViolation(const std::string& violation) { violations_.push_back(violation); }

  /// @throws InputError with all violations and unknown parameters in one line.
  void finish() const;

 private:
  XmlRpc::XmlRpcValue* find(const std::string& key);
  void collectUnknown(XmlRpc::XmlRpcValue values, const std::string& prefix,
                      std::vector<std::string>& unknown) const;

  XmlRpc::XmlRpcValue values_;
  std::string name_;
  std::set<std::string> read_;
  std::vector<std::string> violations_;
};

}  // namespace casepush
