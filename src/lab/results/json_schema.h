#pragma once
// The JSON schema of results.json, made of the fields as they are declared. docs/results.schema.json is this text.

#include <string>

namespace gnomon {

// Draft 2020-12, of both kinds of file: gnomon compare's and gnomon fog's.
std::string resultsJsonSchema();

}  // namespace gnomon
