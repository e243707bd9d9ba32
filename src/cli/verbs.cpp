#include "cli/verbs.h"

namespace gnomon {

// Of the files <name>_verb.cpp.
Verb compareVerb();
Verb sweepVerb();
Verb renderVerb();
Verb exportVerb();
Verb reportVerb();
Verb fogVerb();
Verb vsvVerb();
Verb viewVerb();
Verb sceneVerb();
Verb benchVerb();
Verb reproduceVerb();
Verb infoVerb();
Verb completionVerb();
Verb manVerb();

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = {compareVerb(),   sweepVerb(), renderVerb(),     viewVerb(),  exportVerb(),
                                        reportVerb(),    fogVerb(),   vsvVerb(),        sceneVerb(), benchVerb(),
                                        reproduceVerb(), infoVerb(),  completionVerb(), manVerb()};
  return all;
}

}  // namespace gnomon
