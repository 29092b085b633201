"""Text of LLVM IR to functions and variables, in the dialects of clang 15 to 20."""

import pytest
from rosimpact.impact.values.ir.explore import explore
from rosimpact.impact.values.ir.layout import StructureType
from rosimpact.impact.values.ir.module import UNDEFINED, BytesConstant, Composite, GlobalVariable
from rosimpact.impact.values.ir.reader import Program
from rosimpact.impact.values.outcomes import NOWHERE, Bounds, CodeLine, CrashKind, Reaction

LINES = {
    "add nuw nsw i32 %a, 1": "add",
    "trunc nuw nsw i64 %w to i32": "cast",
    "zext nneg i32 %a to i64": "cast",
    "icmp samesign ult i32 %a, 5": "icmp",
    "fcmp reassoc nnan olt double %d, 0x3FF0000000000000": "fcmp",
    "fadd fast double %d, 1.500000e+00": "fadd",
    "getelementptr inbounds nuw i8, ptr %p, i64 8": "gep",
    "getelementptr inbounds [4 x i32], ptr @table, i64 0, i64 %w": "gep",
    "load atomic i32, ptr %p seq_cst, align 4, !tbaa !3": "load",
    "load volatile i8, ptr %p, align 1, !range !4, !noundef !5": "load",
    "load i8, ptr getelementptr inbounds (i8, ptr @table, i64 3), align 1": "load",
    "select i1 %c, ptr %p, ptr null, !prof !7": "select",
    "select fast i1 %c, double %d, double 0.000000e+00": "select",
    "extractvalue { i32, i1 } %pair, 1": "extractvalue",
    "insertvalue { ptr, i32 } poison, ptr %p, 0": "insertvalue",
    "insertelement <2 x float> poison, float 1.000000e+00, i64 0": "insertelement",
    "shufflevector <2 x float> %v, <2 x float> poison, <2 x i32> <i32 1, i32 0>": "shufflevector",
    "fadd <2 x float> %v, splat (float 1.000000e+00)": "fadd",
    "alloca { i64, [16 x i8] }, align 8": "alloca",
    "atomicrmw add ptr %p, i32 1 acq_rel, align 4": "atomicrmw",
    "cmpxchg weak ptr %p, i32 0, i32 1 seq_cst seq_cst, align 4": "cmpxchg",
    "freeze i32 %a": "freeze",
    "tail call noundef range(i32 0, 10) i32 @read(ptr nocapture noundef captures(none) %p) #5, !dbg !9": "call",
    "call i32 (ptr, ...) @printf(ptr noundef nonnull dereferenceable(1) @.str, i32 noundef %a)": "call",
    "call void %f(ptr noundef byval(%struct.Pair) align 8 %p)": "call",
    'call void asm sideeffect "nop", "~{memory}"()': "asm",
    "fneg double %d": "fneg",
    "sub i64 ptrtoint (ptr @table to i64), %w": "sub",
}
HEAD = """
%struct.Pair = type { i32, [3 x i8], double }
@table = internal unnamed_addr constant [4 x i32] [i32 1, i32 2, i32 3, i32 undef], align 16
@.str = private unnamed_addr constant [4 x i8] c"a\\0Ab\\00", align 1
@_ZTV4Node = linkonce_odr unnamed_addr constant { [3 x ptr] } { [3 x ptr] [ptr null, ptr @table, ptr @read] }, comdat
@other = external global i32
@also = unnamed_addr alias i32, ptr @other
@thread = thread_local(initialexec) global i32 0, align 4

declare noundef i32 @read(ptr nocapture noundef) local_unnamed_addr #1
declare i32 @printf(ptr, ...)
"""


@pytest.mark.parametrize(("line", "opcode"), LINES.items())
def test_an_instruction_is_read(line, opcode):
    result = "" if line.startswith(("call void", "store")) else "%x = "
    text = f"""{HEAD}
define i32 @f(i32 noundef %a, i64 %w, double %d, ptr %p, ptr %f, i1 %c, <2 x float> %v, {{ i32, i1 }} %pair) {{
  {result}{line}
  ret i32 0
}}
"""
    function = Program([text]).get_function("f")
    (block,) = function.blocks.values()
    assert [each.opcode for each in block.instructions] == [opcode, "ret"]
    assert function.parameters == ["%a", "%w", "%d", "%p", "%f", "%c", "%v", "%pair"]


def test_lines_that_belong_together_and_labels_of_unnamed_blocks():
    text = """
define void @f(i32 %0) personality ptr @__gxx_personality_v0 {
  switch i32 %0, label %4 [
    i32 1, label %2
    i32 -1, label %3
  ]

2:                                                ; preds = %1
  invoke void @g(ptr null)
          to label %4 unwind label %5, !dbg !3

3:                                                ; preds = %1
    #dbg_value(i32 %0, !5, !DIExpression(), !6)
  br label %4

4:                                                ; preds = %3, %2, %1
  %.0 = phi i32 [ 1, %2 ], [ 2, %3 ], [ %0, %1 ]
  ret void

5:
  %6 = landingpad { ptr, i32 }
          cleanup
          catch ptr @_ZTISt9exception
          catch ptr null
  resume { ptr, i32 } %6
}
declare void @g(ptr)
declare i32 @__gxx_personality_v0(...)
@_ZTISt9exception = external constant ptr
"""
    function = Program([text]).get_function("f")
    assert list(function.blocks) == ["%1", "%2", "%3", "%4", "%5"]
    assert function.entry == "%1"
    switch = function.blocks["%1"].instructions[0]
    assert switch.extra == ("%4", ((1, "%2"), (0xFFFFFFFF, "%3")))
    assert function.blocks["%2"].instructions[0].extra == ("%4", "%5")
    assert [each.opcode for each in function.blocks["%3"].instructions] == ["jump"]
    assert function.blocks["%4"].phis[0].extra == {"%2": 1, "%3": 2, "%1": "%0"}
    assert function.blocks["%5"].instructions[0].extra == (("catch", "catch"), True)


def test_variables_with_their_values():
    program = Program([HEAD])
    table = program.get_variable("table#0")
    assert isinstance(table, GlobalVariable)
    assert table.is_constant
    assert isinstance(table.value, Composite)
    assert [part for _, part in table.value.parts] == [1, 2, 3, UNDEFINED]
    text = program.get_variable(".str#0")
    assert isinstance(text, GlobalVariable)
    assert text.value == BytesConstant(b"a\nb\0")
    assert program.get_variable("also") == "other"
    assert program.get_variable("other").value is None


def test_sizes_are_those_of_the_machine():
    pair = Program([HEAD]).units[0].find_type("%struct.Pair")
    assert isinstance(pair, StructureType)
    assert pair.offsets == [0, 4, 8]
    assert pair.size == 16


def test_names_of_one_module_are_not_those_of_another():
    own = "@place = internal global i32 {}\ndefine i32 @read_{}() {{\n  %1 = load i32, ptr @place\n  ret i32 %1\n}}\n"
    program = Program([own.format(7, "a"), own.format(8, "b")])
    assert program.get_variable("place#0").value == 7
    assert program.get_variable("place#1").value == 8


@pytest.mark.parametrize(
    "text",
    [
        "",
        "define void @entry(",
        "define void @entry() {\n  %1 = nonsense\n}\n",
        "define void @entry() {\n  %1 = load i32, ptr null\n  ret void\n}\n",
        "define void @entry() {\n  ret void\n",
        "define void @entry() {\n  br label %nowhere\n}\n",
        "define void @entry() {\n  call void @llvm.nothing.known()\n  %1 = add i32 %2, 1\n  ret void\n}\n",
    ],
)
def test_what_is_not_understood_is_unknown_and_never_an_error(text):
    exploration = explore([text], "entry", Bounds(seconds=5), lambda path: True)
    assert {path.result for path in exploration.paths} <= {Reaction.UNKNOWN, Reaction.CRASH}
    assert all(path.reason for path in exploration.paths if path.result is Reaction.UNKNOWN)
    assert exploration.paths


def test_time_paths_and_memory_have_bounds():
    counting = """
define void @entry() {
  br label %1
1:
  %n = phi i64 [ 0, %0 ], [ %next, %1 ]
  %next = add i64 %n, 1
  %over = icmp eq i64 %next, 1000000000000
  br i1 %over, label %2, label %1
2:
  ret void
}
"""
    short = explore([counting], "entry", Bounds(seconds=0.3), lambda path: True)
    assert [(path.result, path.reason) for path in short.paths] == [(Reaction.UNKNOWN, "time limit")]
    assert short.seconds < 30
    many = """
declare i64 @ri_integer(ptr, i32, i32)
@name = constant [2 x i8] c"x\\00"
define void @entry() {
  %x = call i64 @ri_integer(ptr @name, i32 64, i32 0)
  switch i64 %x, label %2 [
    i64 1, label %1
    i64 3, label %3
    i64 4, label %4
  ]
1:
  ret void
2:
  ret void
3:
  ret void
4:
  ret void
}
"""
    few = explore([many], "entry", Bounds(paths=2, seconds=30), lambda path: True)
    assert len(few.paths) == 2
    assert few.left == 2
    none = explore([many], "entry", Bounds(memory=-1, seconds=30), lambda path: True)
    assert (none.paths, none.left) == ([], 1)


def test_a_loop_that_comes_to_the_same_state_is_endless():
    text = """
declare i64 @ri_integer(ptr, i32, i32)
@name = constant [2 x i8] c"x\\00"
@cell = global i32 5
define void @entry() !dbg !3 {
  %x = call i64 @ri_integer(ptr @name, i32 64, i32 0), !dbg !5
  br label %loop, !dbg !5
loop:
  store i32 7, ptr @cell, !dbg !5
  %more = icmp ugt i64 %x, 9, !dbg !5
  br i1 %more, label %loop, label %end, !dbg !5
end:
  ret void, !dbg !5
}
!1 = !DIFile(filename: "node.cpp", directory: "/ws/src")
!3 = distinct !DISubprogram(name: "entry", file: !1, line: 1)
!5 = !DILocation(line: 12, column: 1, scope: !3)
"""
    exploration = explore([text], "entry", Bounds(seconds=60), lambda path: path.startswith("/ws/"))
    found = {(path.result, path.crash, path.place) for path in exploration.paths}
    assert found == {
        (Reaction.IGNORED, None, NOWHERE),
        (Reaction.CRASH, CrashKind.ENDLESS, CodeLine("/ws/src/node.cpp", 12)),
    }


@pytest.mark.parametrize("step, result", [(1, Reaction.IGNORED), (0, Reaction.CRASH)])
def test_a_block_that_is_jumped_back_to_within_a_counting_loop(step, result):
    # The latch stands before the inner loop and has no phi of its own; the counter is the outer block's.
    text = f"""
define void @entry() !dbg !3 {{
  br label %outer, !dbg !5
outer:
  %i = phi i64 [ 0, %0 ], [ %next, %latch ]
  br label %inner, !dbg !5
latch:
  %next = add i64 %i, {step}, !dbg !5
  %over = icmp eq i64 %next, 12
  br i1 %over, label %end, label %outer, !dbg !5
inner:
  %bit = phi i64 [ 0, %outer ], [ %more, %inner ]
  %more = add i64 %bit, 1
  %last = icmp eq i64 %more, 7
  br i1 %last, label %latch, label %inner, !dbg !5
end:
  ret void, !dbg !5
}}
!1 = !DIFile(filename: "node.cpp", directory: "/ws/src")
!3 = distinct !DISubprogram(name: "entry", file: !1, line: 1)
!5 = !DILocation(line: 12, column: 1, scope: !3)
"""
    (path,) = explore([text], "entry", Bounds(seconds=60), lambda path: path.startswith("/ws/")).paths
    assert (path.result, path.crash) == (result, CrashKind.ENDLESS if step == 0 else None)


@pytest.mark.parametrize("asked, exceeded", [("ugt i64 %size, 9", 1), ("ugt i64 %size, 3", 0), ("ugt i64 %size, 2", 0)])
def test_a_size_that_only_a_larger_array_has(asked, exceeded):
    text = f"""
declare i64 @ri_size(ptr, i64)
@name = constant [2 x i8] c"x\\00"
define void @entry() {{
  %size = call i64 @ri_size(ptr @name, i64 3)
  %more = icmp {asked}
  br i1 %more, label %yes, label %no
yes:
  ret void
no:
  ret void
}}
"""
    found = explore([text], "entry", Bounds(seconds=60), lambda path: True)
    assert len(found.exceeded) == exceeded
    assert len(found.paths) == (2 if asked.endswith(" 2") else 1)
