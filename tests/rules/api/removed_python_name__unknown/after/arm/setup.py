from setuptools import setup

setup(
    name='arm',
    version='1.2.0',
    packages=['arm'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/arm']),
        ('share/arm', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['arm = arm.node:main']},
)
