#include "loop/report.hpp"

namespace hosel::loop {

std::string page(const LoopResult& r, const Shots&) { return "<!doctype html><title>" + r.title + "</title><p>" + sentence(r); }

}  // namespace hosel::loop
