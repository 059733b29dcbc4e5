// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/mpi/detail/wait_for.hpp>

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_2::mpi::detail {

/// Returns the number of 8-byte words in a message. Throws std::length_error for a message of 16
/// GiB or more, whose length MPI's int cannot hold.
inline int words_of_message(std::size_t bytes) {
  auto const words = bytes / sizeof(std::int64_t);
  if (words > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error(
        "cayspin::mpi: a message between two parts has 16 GiB or more; use more ranks");
  return static_cast<int>(words);
}

/// Exchanges bytes with each rank, including this one. Sizes are multiples of 8.
inline void exchange_with_all(MPI_Comm comm, std::span<std::span<std::byte const> const> sent,
                              std::span<std::span<std::byte> const> received) {
  constexpr int tag = 2;  // neighbours' ghosts use 0 and 1
  int own = 0;
  MPI_Comm_rank(comm, &own);
  // Lengths are checked first: after an error, no message may be under way.
  for (auto const& message : received) words_of_message(message.size());
  for (auto const& message : sent) words_of_message(message.size());
  std::vector<MPI_Request> requests;
  // Each rank starts with the rank after it, so that not all start with rank 0.
  auto const for_each_rank = [&](auto const& messages, auto const& post) {
    for (std::size_t i = 1; i <= messages.size(); ++i) {
      std::size_t const rank = (static_cast<std::size_t>(own) + i) % messages.size();
      if (auto const& message = messages[rank]; !message.empty())
        post(message.data(), words_of_message(message.size()), static_cast<int>(rank),
             &requests.emplace_back(MPI_REQUEST_NULL));
    }
  };
  for_each_rank(received, [&](std::byte* data, int words, int rank, MPI_Request* request) {
    MPI_Irecv(data, words, MPI_INT64_T, rank, tag, comm, request);
  });
  for_each_rank(sent, [&](std::byte const* data, int words, int rank, MPI_Request* request) {
    MPI_Isend(data, words, MPI_INT64_T, rank, tag, comm, request);
  });
  wait_for(requests);
}

}  // namespace cayspin::inline v0_2::mpi::detail
