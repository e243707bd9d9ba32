#pragma once
// What the file of a user's bias may not hold when it is exported, though it compiles.

#include "lab/export/print_code.h"
#include "lab/export/simplify.h"
#include "shadow/user_bias.h"

#include <set>
#include <string>

namespace gnomon::code {

// `program`: of readVisibilityWith(user), as it was read; `known`: what simplify() is about to take as known; `taken`:
// names that exported code has beside those of declarations.
//
// Throws WorldError, "mine.glsl:12: ...", where the user's file
//   - declares a name that simplify() folds wherever it stands, whatever it is: `kind`, `reach`;
//   - defines a function twice, or one beside a built-in one that is called, since exported code has no overloads;
//   - declares a name that is another's once it has export's prefix, or the "_" behind a word of the language's own;
//   - calls a variable as a structure is called, or uses one in another case of the switch than declares it;
//   - does anything with knobs but read params.knobs[kUserWidth];
//   - reads a variable of the calling shader: `gl_FragCoord`, `mapSlices`;
//   - has what is not translated to the language, or would mean something else there (untranslated.h).
void refuseUserCode(const Program& program, const UserBias& user, const Known& known, Language language,
                    const std::set<std::string>& taken);

// `program`: what simplify() left. Throws WorldError where the user's code still has a BiasParams, which no exported
// code has.
void refuseLeftParams(const Program& program, const UserBias& user);

}  // namespace gnomon::code
