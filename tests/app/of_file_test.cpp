#include "app/of_file.hpp"

#include <gtest/gtest.h>

#include "command.hpp"

namespace hosel::test {
namespace {

namespace fs = std::filesystem;

/// Read again after each change, by what is kept only while the file is the same.
class OfFileTest : public ::testing::Test {
 protected:
  std::string read(app::OfFile<std::string>& kept) {
    return kept.get(file_, [&] { return fs::exists(file_) ? content(file_) : "none"; });
  }
  /// Long enough ago that another change would have another time.
  void change(const std::string& text) {
    write(file_, text);
    fs::last_write_time(file_, fs::file_time_type::clock::now() - std::chrono::hours(++changes_));
  }
  fs::path file_ = fresh_directory("of_file") / "entry";
  int changes_ = 0;
};

TEST_F(OfFileTest, AChangeIsSeenAtOnceUnlessAStudyIsAtWork) {
  app::OfFile<std::string> always, once(true);
  change("one");
  EXPECT_EQ(read(always) + read(once), "oneone");
  {
    const app::StudyFiles study;
    EXPECT_EQ(read(once), "one");
    change("two");
    EXPECT_EQ(read(always), "two");
    EXPECT_EQ(read(once), "one") << "all points of a study see the same";
    const app::StudyFiles inside;
    EXPECT_EQ(read(once), "one") << "that of a study inside it too";
  }
  EXPECT_EQ(read(once), "two");
  const app::StudyFiles next;
  EXPECT_EQ(read(once), "two");
}

TEST_F(OfFileTest, WhatIsNotThereIsSoForAWholeStudyAndNoLonger) {
  app::OfFile<std::string> once(true);
  {
    const app::StudyFiles study;
    EXPECT_EQ(read(once), "none");
    change("one");
    EXPECT_EQ(read(once), "none");
  }
  EXPECT_EQ(read(once), "one");
}

}  // namespace
}  // namespace hosel::test
