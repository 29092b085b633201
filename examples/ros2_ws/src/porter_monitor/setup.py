from setuptools import find_packages, setup

package_name = "porter_monitor"

setup(
    name=package_name,
    version="0.4.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{package_name}"]),
        (f"share/{package_name}", ["package.xml", "limits.yaml"]),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=True,
    maintainer="Porter team",
    maintainer_email="porter@example.com",
    description="Watches the battery of the porter and says when it should return to its dock.",
    license="Apache-2.0",
    entry_points={"console_scripts": ["battery_monitor = porter_monitor.node:main"]},
)
