#pragma once

#include "server/store/sqlite.h"

namespace lpf::server {

/// Makes the tables in a new file, and brings those of an older program up to date.
/// @throws Error{StorageFailure} if a newer program made them, or the file is damaged
void create_schema(SqliteDatabase& db);

}  // namespace lpf::server
