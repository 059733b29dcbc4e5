// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../host_device.hpp"

#include_next <KokkosCore_Config_DeclareBackend.hpp>
