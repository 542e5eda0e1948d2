/// Which columns are bookkeeping (clubs, hands, sessions, ...), and which shots they leave out.
#pragma once

#include "app/import/reading.hpp"

namespace hosel::app {

/// Which columns are bookkeeping: of several for one role the one whose cells the dictionary knows best, then the
/// first.
void find_roles(Reading& r);

/// Shots that the file itself marks as deleted, or as none of its statistics.
void leave_out_unused(Reading& r);

/// Leaves out the shots of other clubs than --club names.
void keep_one_club(Reading& r);

/// A club's first spelling for all of its shots.
void one_name_a_club(Reading& r);

}  // namespace hosel::app
