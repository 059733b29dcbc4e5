// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// A run in stages: [[stage]].
namespace cayspin::inline v0_2::io {

/// Returns all stages of a run: the scene's own tables, and the stages after them. The start of
/// each is set as if no stage before it ended early.
std::vector<Stage> stages_of(Scene const& scene);

/// Returns the start of the stage `next`, which follows `stage` after step `step`.
StageBegin begin_after(Scene const& stage, std::int64_t step, Scene const& next);

/// Sets the start of each stage after `first` to the end of the stage before it.
void put_begins(std::vector<Stage>& stages, std::size_t first);

/// Returns the last step of a stage, or the step after which it starts if it takes no steps.
std::int64_t end_of(Stage const& stage);

/// Returns the number of a stage with its name, if it has one: "stage 1 (switch)".
std::string stage_text(Stage const& stage);

/// Throws SceneError for a scene in stages. `who`: the command or function that accepts no stages,
/// for the message.
void require_no_stages(Scene const& scene, std::string_view who);

/// Returns the scene with keys changed by the rules of [[stage]], for a run that continues from a
/// state of `scene`. `given`: numbers for keys with { given = true }. The overrides are written as
/// for `--set`. Throws SceneError, also for keys that no stage may change.
Scene changed_on_the_way(Scene const& scene, std::vector<std::string> const& overrides,
                         Given const& given = {});

}  // namespace cayspin::inline v0_2::io
