#include "daemon/json_rpc.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/params.h"

namespace edgepose {
namespace {

RpcCode code_of(const std::string& line) {
  try {
    parse_request(line);
  } catch (const RpcError& error) {
    return error.code;
  }
  return RpcCode{0};
}

TEST(JsonRpc, Requests) {
  const RpcRequest request =
      parse_request(R"({"jsonrpc":"2.0","id":"x","method":"status","params":{"a":1}})");
  EXPECT_EQ(request.id, "\"x\"");
  EXPECT_EQ(request.method, "status");
  EXPECT_EQ(request.params, R"({"a":1})");
  EXPECT_TRUE(parse_request(R"({"jsonrpc":"2.0","method":"m"})").is_notification);
}

TEST(JsonRpc, WhatIsNone) {
  EXPECT_EQ(code_of("{"), RpcCode::kNoJson);
  EXPECT_EQ(code_of("\xff\xfe"), RpcCode::kNoJson);
  EXPECT_EQ(code_of("[]"), RpcCode::kNoRequest);
  EXPECT_EQ(code_of(R"({"id":1,"method":"m"})"), RpcCode::kNoRequest);
  EXPECT_EQ(code_of(R"({"jsonrpc":"2.0","id":{},"method":"m"})"), RpcCode::kNoRequest);
  EXPECT_EQ(code_of(R"({"jsonrpc":"2.0","id":1,"method":7})"), RpcCode::kNoRequest);
  EXPECT_EQ(code_of(R"({"jsonrpc":"2.0","id":1,"method":"m","params":[1]})"), RpcCode::kBadParams);
  EXPECT_EQ(code_of(std::string(60000, '[')), RpcCode::kNoJson) << "deep nesting";
}

TEST(JsonRpc, AnswersAreOneLine) {
  const std::string line = error_line("7", RpcCode::kNoModel, "a\nb \"c\" \xff");
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto parsed = nlohmann::json::parse(line);
  EXPECT_EQ(parsed["error"]["code"], 2);
  EXPECT_EQ(nlohmann::json::parse(result_line("null", "[1]"))["result"][0], 1);
}

TEST(JsonRpcParams, EachFaultIsNamed) {
  const auto fault = [](const auto& use) -> std::string {
    try {
      use();
    } catch (const RpcError& error) {
      return error.code == RpcCode::kBadParams ? error.what() : "another code";
    }
    return "";
  };
  EXPECT_NE(fault([] {
              Params(R"({"nmae":1})", {"name", "mesh"});
            }).find("did you mean name"),
            std::string::npos);
  const Params params(R"({"name":"a","flag":1,"number":"x","path":"relative","empty":"","list":[1]})",
                      {"name", "flag", "number", "path", "empty", "list", "missing"});
  EXPECT_EQ(params.text("name"), "a");
  EXPECT_NE(fault([&] { (void)params.text("missing"); }), "");
  EXPECT_NE(fault([&] { (void)params.flag("flag", true); }), "");
  EXPECT_NE(fault([&] { (void)params.number("number", 1); }), "");
  EXPECT_NE(fault([&] { (void)params.path("path"); }), "");
  EXPECT_NE(fault([&] { (void)params.text("empty"); }), "");
  EXPECT_NE(fault([&] { (void)params.texts("list"); }), "");
}

}  // namespace
}  // namespace edgepose
