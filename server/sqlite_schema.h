#pragma once

#include "server/sqlite.h"

namespace lpf::server {

/// Makes the tables in a new file. @throws Error{StorageFailure} if a newer program made them
void create_schema(SqliteDatabase& db);

}  // namespace lpf::server
