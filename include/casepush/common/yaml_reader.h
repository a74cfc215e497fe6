#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace casepush {

/// Reads one YAML map strictly: wrong types, values out of bounds, and keys that nobody read are
/// InputErrors which name the file and the key.
///
/// Usage: read every key, then call `finish()`.
class YamlReader {
 public:
  /// @throws InputError if the file cannot be read (e.g. a folder or FIFO), is not YAML, or is not
  /// a map.
  static YamlReader fromFile(const std::filesystem::path& path);
  static YamlReader fromText(const std::string& text, const std::string& name);

  ~YamlReader();
  YamlReader(YamlReader&&) noexcept;
  YamlReader& operator=(YamlReader&&) noexcept;

  bool has(const std::string& key) const;

  /// Finite number in [low, high]. Without a default the key is required.
  double number(const std::string& key, double low, double high);
  double number(const std::string& key, double low, double high, double default_value);
  int integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high, int default_value);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& default_value);
  std::string block(const std::string& key);  ///< Text of one or more lines; required.
  bool flag(const std::string& key, bool default_value);

  /// List of finite numbers of the given length (`count` < 0: any length).
  std::vector<double> numbers(const std::string& key, int count);

  /// List of non-empty texts, each on one line; empty if absent.
  std::vector<std::string> texts(const std::string& key);

  YamlReader child(const std::string& key);  ///< Map under `key`; required.
  std::optional<YamlReader> optionalChild(const std::string& key);
  std::vector<YamlReader> children(const std::string& key);  ///< List of maps; empty if absent.

  /// @throws InputError naming every key that was never read.
  void finish() const;

  /// "file: path.to.key", for messages of the caller's own checks.
  std::string where(const std::string& key = "") const;

 private:
  struct State;
  explicit YamlReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace casepush
