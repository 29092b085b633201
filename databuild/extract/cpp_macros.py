"""Macros of ROS libraries that declare something where they stand, and what they declare.

Read from the headers that define them: rclcpp/macros.hpp, moveit/macros/class_forward.h and declare_ptr.h,
ros/message_forward.h, urdf_model/types.h, ompl/util/ClassForward.h, rclcpp_lifecycle's and rviz's uses of them.
"""

from __future__ import annotations

from functools import lru_cache

from .cpp_types import split, split_tokens

_SHARED = "using SharedPtr = std::shared_ptr<T>; using ConstSharedPtr = std::shared_ptr<const T>;"
_MAKE_SHARED = "template<typename... Args> static std::shared_ptr<T> make_shared(Args&&... args);"
_WEAK = "using WeakPtr = std::weak_ptr<T>; using ConstWeakPtr = std::weak_ptr<const T>;"
_UNIQUE = "using UniquePtr = std::unique_ptr<T>;"
_MAKE_UNIQUE = "template<typename... Args> static std::unique_ptr<T> make_unique(Args&&... args);"
_POINTERS = (
    "typedef std::shared_ptr<T> T##Ptr; typedef std::shared_ptr<const T> T##ConstPtr;"
    " typedef std::weak_ptr<T> T##WeakPtr; typedef std::weak_ptr<const T> T##ConstWeakPtr;"
    " typedef std::unique_ptr<T> T##UniquePtr; typedef std::unique_ptr<const T> T##ConstUniquePtr;"
)
_MESSAGE = (
    "typedef T##_<std::allocator<void>> T;"
    " typedef boost::shared_ptr<T> T##Ptr; typedef boost::shared_ptr<T const> T##ConstPtr;"
)

DECLARES: dict[str, tuple[tuple[str, ...], str]] = {
    "RCLCPP_DISABLE_COPY": (("T",), "T(const T&) = delete; T& operator=(const T&) = delete;"),
    "RCLCPP_SMART_PTR_DEFINITIONS": (("T",), _SHARED + _MAKE_SHARED + _WEAK + _UNIQUE + _MAKE_UNIQUE),
    "RCLCPP_SMART_PTR_DEFINITIONS_NOT_COPYABLE": (("T",), _SHARED + _MAKE_SHARED + _WEAK + _UNIQUE),
    "RCLCPP_SMART_PTR_ALIASES_ONLY": (("T",), _SHARED + _WEAK + _UNIQUE + _MAKE_SHARED),
    "RCLCPP_SHARED_PTR_DEFINITIONS": (("T",), _SHARED + _MAKE_SHARED),
    "RCLCPP_WEAK_PTR_DEFINITIONS": (("T",), _WEAK),
    "RCLCPP_UNIQUE_PTR_DEFINITIONS": (("T",), _UNIQUE + _MAKE_UNIQUE),
    "MOVEIT_CLASS_FORWARD": (("T",), _POINTERS),
    "MOVEIT_STRUCT_FORWARD": (("T",), _POINTERS),
    "MOVEIT_DECLARE_PTR": (("N", "T"), _POINTERS.replace("T##", "N##")),
    "MOVEIT_DECLARE_PTR_MEMBER": (("T",), _POINTERS.replace("T##", "")),
    "ROS_DECLARE_MESSAGE": (("T",), _MESSAGE),
    "OMPL_CLASS_FORWARD": (("T",), "typedef std::shared_ptr<T> T##Ptr;"),
    "URDF_TYPEDEF_CLASS_POINTER": (
        ("T",),
        "typedef std::shared_ptr<T> T##SharedPtr; typedef std::shared_ptr<const T> T##ConstSharedPtr;"
        " typedef std::weak_ptr<T> T##WeakPtr;",
    ),
    "EIGEN_MAKE_ALIGNED_OPERATOR_NEW": ((), ""),
    "Q_OBJECT": ((), "static const QMetaObject staticMetaObject; virtual const QMetaObject* metaObject() const;"),
}
"""Macro: the names of its parameters, and the declarations it stands for, written in those (`T##Ptr` joins)."""


@lru_cache(maxsize=1024)
def expand_macro(name: str, arguments: tuple[str, ...]) -> list[list[str]]:
    """The declarations of a known macro, each as tokens."""
    parameters, text = DECLARES[name]
    given = split(list(arguments))
    if len(parameters) == 1:
        given = [list(arguments)]
    values = dict(zip(parameters, given, strict=False))
    statements: list[list[str]] = []
    for statement in text.split(";"):
        tokens: list[str] = []
        pending = False
        for token in split_tokens(statement.replace("##", " \x01 ")):
            if token == "\x01":
                pending = True
            elif pending:
                tokens[-1] += token
                pending = False
            else:
                tokens += values.get(token, [token])
        if tokens:
            statements.append(tokens)
    return statements
