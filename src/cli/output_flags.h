#pragma once
// -o and --json: where a run's results go.

#include <string>

namespace CLI {
class App;
}

namespace gnomon {

// A folder that a verb makes. Throws UsageError, with the remedy, where its name is that of a file ("turn.mp4") or of
// standard output, and there is no such folder.
void checkFolderName(const std::string& out, const std::string& remedy);

// Throws UsageError where a flag that names a file to write names what this run reads, or what another flag writes.
void refuseToWriteOverInputs(const CLI::App& verb);

}  // namespace gnomon
