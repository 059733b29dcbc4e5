// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/io/scene.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_1::io::test {

/// A folder of its own for each test, removed afterwards.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "cayspin_scene_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  Folder(Folder const&) = delete;
  Folder& operator=(Folder const&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  std::filesystem::path write(std::string_view text, std::string_view name = "scene.toml") const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline constexpr std::string_view llg_scene = R"toml([system]
kind = "llg"
damping = 0.05
precession = true

[lattice]
shape = [4, 3]
spacing = [1.0, 0.5]
boundary = ["open", "periodic"]

[field]
exchange = 1.0
anisotropy = { constant = 1.0, axis = [0, 0, 2] }
applied = [0.05, "0.1*cos(t)", 0]
slab_demag = { normal = [1, 0, 0], strength = 2 }
mu0 = 1.5

[initial]
uniform = [0.3, 0.5, 0.8]

[integrator]
method = "rkmk4"
generator = "default"
isotropy = "zero"
rotation = "cayley"
dt = 0.01
end = 60.0

[output]
file = "slab.h5"
every = 100
)toml";

inline constexpr std::string_view body_scene = R"toml([system]
kind = "rigid_body"
inertia = [1.0, 2.0, 3.0]

[lattice]
shape = [5]

[initial]
random = { seed = 1 }

[integrator]
method = "rkmk4"
dt = 0.1
steps = 10
)toml";

/// `text` with its one occurrence of `from` replaced.
inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  auto const at = result.find(from);
  if (at == std::string::npos) throw std::runtime_error("not in the scene: " + std::string(from));
  return result.replace(at, from.size(), to);
}

/// The message with which a scene is refused, or nothing.
inline std::optional<std::string> refusal(std::filesystem::path const& path,
                                          std::vector<std::string> const& overrides = {}) {
  try {
    read_scene(path, overrides);
    return std::nullopt;
  } catch (SceneError const& error) {
    return error.what();
  }
}

inline Scene read_text(Folder const& folder, std::string_view text,
                       std::vector<std::string> const& overrides = {}) {
  return read_scene(folder.write(text), overrides);
}

/// A scene made wrong by one replacement, and what its message must hold after the file's name.
struct WrongScene {
  char const* name;
  char const* from;
  char const* to;
  char const* begins;    ///< ":LINE: key: ..."
  char const* contains;  ///< what is wrong or accepted
};

inline void PrintTo(WrongScene const& wrong, std::ostream* stream) { *stream << wrong.to; }

inline std::string name_of(testing::TestParamInfo<WrongScene> const& info) {
  return info.param.name;
}

inline void expect_refused(std::string_view scene, WrongScene const& wrong) {
  Folder const folder;
  auto const path = folder.write(replaced(scene, wrong.from, wrong.to));
  auto const message = refusal(path);
  ASSERT_TRUE(message) << "the scene was accepted";
  EXPECT_TRUE(message->starts_with(path.string() + wrong.begins)) << *message;
  EXPECT_NE(message->find(wrong.contains), std::string::npos) << *message;
  EXPECT_EQ(message->find('\n'), std::string::npos) << *message;
}

}  // namespace cayspin::inline v0_1::io::test
