// The table and the page of a batch, and what is said of it.
#pragma once

#include <string>
#include <vector>

#include "batch/outcome.h"
#include "batch/store.h"

namespace photohull::cli {

/// What the store knows of the rows that have no outcome.
void fill(std::vector<batch::Row>& rows, const batch::Store& store);

/// batch.csv and index.html.
void write_overview(const std::vector<batch::Row>& rows, const batch::Store& store);

/// The sum of it, `more` said of their number. Throws where not all have good results; where some
/// are not made yet, returns how many.
int tell(const std::vector<batch::Row>& rows, const std::string& more, bool json,
         const batch::Store& store);

/// The table of what is there, and the sum of it. Throws as run_batch does, and Error where pieces
/// are not made yet.
void merge_batch(const std::vector<std::string>& names, const batch::Store& store);

}  // namespace photohull::cli
