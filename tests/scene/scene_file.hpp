// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io::test {

/// A separate folder for each test, removed afterwards.
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

/// A short scene, to which tests add keys.
inline constexpr std::string_view plain_scene = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4, 3, 2]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 0.01
steps = 10
)toml";

/// Returns `text` with the first occurrence of `from` replaced. Throws std::runtime_error if there
/// is none.
inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  auto const at = result.find(from);
  if (at == std::string::npos) throw std::runtime_error("not in the scene: " + std::string(from));
  return result.replace(at, from.size(), to);
}

/// scene_of() parses a text as a scene. read_text() first writes the text into a folder, which may
/// contain the other files of the scene, and reads it from there.
inline Scene scene_of(std::string_view text, std::vector<std::string> const& overrides = {}) {
  return parse_scene(std::string(text), "scene.toml", overrides);
}
inline Scene read_text(Folder const& folder, std::string_view text,
                       std::vector<std::string> const& overrides = {}) {
  return read_scene(folder.write(text), overrides);
}

inline SiteBox whole(Scene const& scene) { return {{0, 0, 0}, scene.lattice.shape}; }

/// Returns the one-line message of the SceneError that `work` throws; "accepted" if there is none.
template <class Work>
std::string refusal(Work const& work) {
  try {
    work();
    return "accepted";
  } catch (SceneError const& error) {
    std::string const message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
}
/// Returns the message of the error in a scene's text, or "accepted".
inline std::string refusal_of(std::string_view text,
                              std::vector<std::string> const& overrides = {}) {
  return refusal([&] { scene_of(text, overrides); });
}

inline void expect_holds(std::string const& message, std::string_view part) {
  EXPECT_NE(message.find(part), std::string::npos) << message << "\nexpected: " << part;
}

}  // namespace cayspin::inline v0_2::io::test
