#include "post/parse_json.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace hosel::post {
using nlohmann::json;

namespace {

/// Reads and keeps nothing; stops at the first list that is too deep.
class DepthGuard : public nlohmann::json_sax<json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t) override { return deeper(); }
  bool start_array(std::size_t) override { return deeper(); }
  bool end_object() override { return --depth_, true; }
  bool end_array() override { return --depth_, true; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }

 private:
  bool deeper() {
    constexpr int deepest = 100;
    if (++depth_ > deepest) throw std::length_error("more than 100 lists and objects in one another");
    return true;
  }
  int depth_ = 0;
};

json parse(std::string_view text, json::input_format_t format) {
  // What walks, prints or compares a tree calls itself at every level, and so does the reader of CBOR.
  DepthGuard guard;
  json::sax_parse(text, &guard, format);
  return format == json::input_format_t::cbor ? json::from_cbor(text) : json::parse(text);
}

}  // namespace

json parse_json(std::string_view text) { return parse(text, json::input_format_t::json); }
json parse_cbor(std::string_view bytes) { return parse(bytes, json::input_format_t::cbor); }

}  // namespace hosel::post
